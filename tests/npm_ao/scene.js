// SPDX-License-Identifier: GPL-3.0-or-later
// The scene of the pages: a floor, a wall and things on it, below sky.
import * as THREE from 'three';

export function sceneOf() {
	const scene = new THREE.Scene().add(new THREE.HemisphereLight(0xffffff, 0xffffff, Math.PI));
	scene.background = new THREE.Color(0x8080ff);
	const grey = new THREE.MeshLambertMaterial({ color: 0xffffff });
	const box = (x, y, z, dx, dy, dz, material = grey) => {
		const mesh = new THREE.Mesh(new THREE.BoxGeometry(dx, dy, dz), material);
		mesh.position.set(x, y, z);
		scene.add(mesh);
		return mesh;
	};
	box(0, -0.5, 0, 12, 1, 12);
	box(0, 1, -3, 8, 2, 0.5);
	box(-1.5, 0.4, -1, 0.8, 0.8, 0.8).rotation.y = 0.5;
	box(1.2, 0.25, 0, 1.5, 0.5, 0.5).rotation.y = -0.3;
	box(1.2, 0.9, -1.8, 0.3, 1.8, 0.3);
	const ball = new THREE.Mesh(new THREE.SphereGeometry(0.5, 32, 16), grey);
	ball.position.set(0, 0.5, -0.8);
	scene.add(ball);
	return { scene, grey, box, ball };
}

export function cameraOf(camera) {
	camera.position.set(0.6, 2, 4);
	camera.lookAt(0, 0.5, -1);
	camera.updateMatrixWorld();
	return camera;
}
