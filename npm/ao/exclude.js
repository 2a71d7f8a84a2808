// SPDX-License-Identifier: MIT
// Objects that are drawn over the obscurance.

/** The visible objects that a pass excludes by its options. */
export function excludedOf({ scene, camera, excludeTransparent, excludeLayers }) {
	let mask = 0;
	for (const layer of excludeLayers) mask |= 1 << layer;
	const excluded = [];
	scene.traverseVisible(object => {
		if (!object.material || !object.layers.test(camera.layers)) return;
		const transparent = excludeTransparent && [object.material].flat().every(material => material.transparent);
		if (transparent || (object.layers.mask & mask) !== 0) excluded.push(object);
	});
	return excluded;
}

// Hides objects from the next drawing without hiding their children. Those that cast a shadow stay, with a material that draws
// nothing, so that the shadow stays as well. Returns what show() needs to undo it. invisible: such materials of each `side`.
export function hide(objects, invisible) {
	return objects.map(object => {
		const hidden = [object, object.layers.mask, object.material];
		if (object.castShadow && object.isMesh) object.material = invisible[[object.material].flat()[0].side];
		else object.layers.mask = 0;
		return hidden;
	});
}

/** Hides all objects but these, also from shadows that are drawn now. */
export function hideOthers(scene, objects) {
	const others = [];
	scene.traverse(object => {
		if (object.layers.mask !== 0 && (object.isMesh || object.isLine || object.isPoints || object.isSprite) && !objects.includes(object)) others.push([object, object.layers.mask, null]);
	});
	for (const [object] of others) object.layers.mask = 0;
	return others;
}

export function show(hidden) {
	for (const [object, mask, material] of hidden) {
		object.layers.mask = mask;
		if (material) object.material = material;
	}
}
