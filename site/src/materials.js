// SPDX-License-Identifier: GPL-3.0-or-later
// Materials of the built-in levels, by the names of theirs: patterns computed at each point of the surface, so no pictures are needed.
import * as THREE from 'three';

// Each sets colour, rough and, where it has joints or boards, height, whose slope bends the normal. p: metres in the surface's own
// plane, v up; n: the world normal.
const NOISE = `
varying vec3 surface_at;
varying vec3 surface_normal;
float hash21(vec2 p) { p = fract(p * vec2(123.34, 456.21)); p += dot(p, p + 45.32); return fract(p.x * p.y); }
float noise2(vec2 p) {
	vec2 i = floor(p), f = fract(p), u = f * f * (3.0 - 2.0 * f);
	return mix(mix(hash21(i), hash21(i + vec2(1, 0)), u.x), mix(hash21(i + vec2(0, 1)), hash21(i + vec2(1, 1)), u.x), u.y);
}
float cloud(vec2 p) { return 0.5 * noise2(p) + 0.3 * noise2(2.3 * p + 7.1) + 0.2 * noise2(5.1 * p + 3.3); }
// Distance to the nearest joint of a bond, and the number of the stone.
vec3 bond(vec2 p, vec2 size) {
	float row = floor(p.y / size.y);
	p.x += 0.5 * size.x * mod(row, 2.0);
	vec2 cell = floor(p / size), in_cell = p - cell * size, edge = min(in_cell, size - in_cell);
	return vec3(min(edge.x, edge.y), cell);
}`;
const paved = (size, light, dark, joint) => `vec3 b = bond(p, vec2(${size})); float stone = hash21(b.yz), j = smoothstep(0.0, 0.012, b.x);
colour = mix(vec3(${joint}), mix(vec3(${light}), vec3(${dark}), 0.65 * stone + 0.35 * cloud(9.0 * p)), j); rough = 0.9; height = 0.006 * j + 0.002 * cloud(20.0 * p);`;
const boards = (width, light, dark) => `float board = floor(p.x / ${width}), edge = abs(fract(p.x / ${width}) - 0.5) * 2.0;
float grain = cloud(vec2(p.x * 60.0 + 31.0 * hash21(vec2(board, 1.0)), p.y * 2.5 + 9.0 * board));
colour = mix(vec3(${light}), vec3(${dark}), 0.6 * grain + 0.4 * hash21(vec2(board, 7.0))) * mix(1.0, 0.45, smoothstep(0.93, 1.0, edge)); rough = 0.7; height = -0.004 * smoothstep(0.9, 1.0, edge);`;
const LOOKS = {
	ground: `float flat_part = smoothstep(0.5, 0.9, n.y), c = cloud(0.7 * p), fine = cloud(14.0 * p);
colour = mix(vec3(0.23, 0.17, 0.11), mix(vec3(0.10, 0.19, 0.05), vec3(0.22, 0.27, 0.09), c), flat_part) * (0.7 + 0.6 * fine); rough = 1.0; height = 0.02 * fine;`,
	render: `float c = cloud(0.8 * p), fine = cloud(45.0 * p); colour = mix(vec3(0.78, 0.70, 0.57), vec3(0.70, 0.60, 0.46), c) * (0.92 + 0.12 * fine);
colour = mix(colour, vec3(0.42, 0.37, 0.30), 0.5 * smoothstep(0.9, 0.1, world.y) * cloud(3.0 * p)); rough = 0.95; height = 0.003 * fine;`,
	wood: boards('0.14', '0.40, 0.25, 0.13', '0.24, 0.13, 0.06'),
	tile: `vec2 size = vec2(0.24, 0.34); float row = floor(p.y / size.y), shift = p.x + 0.12 * mod(row, 2.0); float turn = fract(shift / size.x), down = fract(p.y / size.y);
float one = hash21(vec2(floor(shift / size.x), row)); colour = mix(vec3(0.42, 0.15, 0.08), vec3(0.56, 0.25, 0.14), one) * (0.8 + 0.3 * cloud(12.0 * p)) * mix(0.45, 1.0, smoothstep(0.0, 0.14, down));
rough = 0.75; height = 0.03 * sin(3.14159 * turn) - 0.02 * down;`,
	steel: `float c = cloud(vec2(2.0 * p.x, 60.0 * p.y)); colour = mix(vec3(0.50, 0.52, 0.54), vec3(0.62, 0.63, 0.64), c); rough = 0.35 + 0.2 * c; metal = 0.6;`,
	netting: 'colour = vec3(0.45, 0.47, 0.46); rough = 0.5; metal = 0.5;',
	leaves: 'float c = cloud(1.5 * p); colour = mix(vec3(0.10, 0.22, 0.04), vec3(0.28, 0.36, 0.08), c) * (0.75 + 0.5 * noise2(25.0 * p)); rough = 0.8;',
	grass: 'colour = mix(vec3(0.10, 0.19, 0.05), vec3(0.32, 0.40, 0.12), clamp(2.5 * world.y, 0.0, 1.0)) * (0.8 + 0.4 * noise2(30.0 * p)); rough = 0.9;',
	paving: paved('0.6, 0.6', '0.52, 0.48, 0.42', '0.36, 0.33, 0.29', '0.16, 0.14, 0.12'),
	stone: paved('0.9, 0.42', '0.66, 0.58, 0.46', '0.54, 0.46, 0.35', '0.34, 0.29, 0.22'),
};

function look(material, name) {
	material.onBeforeCompile = shader => {
		shader.vertexShader = `varying vec3 surface_at;\nvarying vec3 surface_normal;\n${shader.vertexShader}`.replace('#include <fog_vertex>', `#include <fog_vertex>
surface_at = (modelMatrix * vec4(transformed, 1.0)).xyz;
surface_normal = mat3(modelMatrix) * objectNormal;`);
		shader.fragmentShader = shader.fragmentShader.replace('void main() {', `${NOISE}
void lookOf(vec3 world, vec3 n, out vec3 colour, out float rough, out float metal, out float height) {
	vec3 a = abs(n);
	vec2 p = a.y > max(a.x, a.z) ? world.xz : vec2(a.x > a.z ? world.z : world.x, world.y);
	colour = vec3(0.5); rough = 0.9; metal = 0.0; height = 0.0;
	${LOOKS[name]}
}
void main() {
	vec3 look_colour; float look_rough, look_metal, look_height;
	lookOf(surface_at, normalize(surface_normal), look_colour, look_rough, look_metal, look_height);`)
			.replace('#include <color_fragment>', '#include <color_fragment>\ndiffuseColor.rgb = look_colour;')
			.replace('#include <roughnessmap_fragment>', 'float roughnessFactor = look_rough;')
			.replace('#include <metalnessmap_fragment>', 'float metalnessFactor = look_metal;')
			// The slope of the height, from screen-space differences (Mikkelsen 2010, Bump Mapping Unparametrized Surfaces on the GPU).
			.replace('#include <normal_fragment_maps>', `#include <normal_fragment_maps>
vec3 side_x = dFdx(vViewPosition), side_y = dFdy(vViewPosition), across_x = cross(side_y, normal), across_y = cross(normal, side_x);
float span = dot(side_x, across_x);
vec3 slope = sign(span) * (dFdx(look_height) * across_x + dFdy(look_height) * across_y);
normal = normalize(abs(span) * normal - clamp(1.0 / (1.0 + 40.0 * length(fwidth(surface_at))), 0.0, 1.0) * slope);`);
	};
	material.customProgramCacheKey = () => `look ${name}`;
	return material;
}

/** Gives the meshes of a built-in level materials by the names of theirs. */
export function dress(root) {
	const made = new Map();
	root.traverse(({ isMesh, material }) => {
		if (!isMesh || made.has(material)) return;
		const { name, map, alphaTest, side } = material;
		const dressed = new THREE.MeshStandardMaterial({ name, map, alphaTest, side });
		made.set(material, name in LOOKS ? look(dressed, name) : dressed);
	});
	root.traverse(object => {
		if (object.isMesh) object.material = made.get(object.material);
	});
}
