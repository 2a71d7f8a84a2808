// SPDX-License-Identifier: MIT
// Visibility that `nook bake` stored in a level, as the attribute _VISIBILITY of its vertices.

function replaced(shader, chunk, text, stage) {
	const include = `#include <${chunk}>`;
	if (!shader[stage].includes(include)) throw new Error(`useBakedVisibility: found a material without ${include}, expected one of three.js that is lit`);
	shader[stage] = shader[stage].replace(include, text);
}

/**
 * Multiplies ambient light by the baked visibility of every mesh below `root` that has it; a light map already contains occlusion, so
 * it darkens only once where there is none. Opaque materials also write the visibility to alpha, which NookPass reads with baked: true.
 * Materials are cloned. Returns the number of meshes.
 */
export function useBakedVisibility(root) {
	const made = new Map();
	let meshes = 0;
	root.traverse(object => {
		const { attributes } = object.geometry ?? {};
		if (!object.isMesh || !attributes?._visibility) return;
		const back = attributes._visibility_back !== undefined;
		const change = material => {
			const key = `${material.uuid},${back}`;
			if (!made.has(key)) made.set(key, changed(material, back));
			return made.get(key);
		};
		object.material = Array.isArray(object.material) ? object.material.map(change) : change(object.material);
		++meshes;
	});
	return meshes;
}

function changed(material, back) {
	const made = material.clone();
	const before = material.onBeforeCompile;
	made.onBeforeCompile = (shader, renderer) => {
		before.call(made, shader, renderer);
		replaced(shader, 'begin_vertex', `#include <begin_vertex>
nook_baked = vec2(_visibility, ${back ? '_visibility_back' : '_visibility'});`, 'vertexShader');
		shader.vertexShader = `attribute float _visibility${back ? ', _visibility_back' : ''};\nvarying vec2 nook_baked;\n${shader.vertexShader}`;
		replaced(shader, 'aomap_fragment', `#include <aomap_fragment>
float nook_open = gl_FrontFacing ? nook_baked.x : nook_baked.y;
reflectedLight.indirectDiffuse *= nook_open;
reflectedLight.indirectSpecular *= nook_open;`, 'fragmentShader');
		replaced(shader, 'opaque_fragment', `#include <opaque_fragment>
#ifdef OPAQUE
gl_FragColor.a = nook_open;
#endif`, 'fragmentShader');
		shader.fragmentShader = `varying vec2 nook_baked;\n${shader.fragmentShader}`;
	};
	made.customProgramCacheKey = () => `${material.customProgramCacheKey()},nook_baked,${back}`;
	return made;
}
