// SPDX-License-Identifier: MIT
// The pass for the EffectComposer of three.js, and what it shares with that for `postprocessing`.
import {
	AddEquation, Color, CustomBlending, DepthTexture, FloatType, HalfFloatType, MeshBasicMaterial, MeshNormalMaterial, OneFactor, RedFormat, SrcColorFactor,
	UnsignedByteType, WebGLRenderTarget, ZeroFactor,
} from 'three';
import { FullScreenQuad, Pass } from 'three/addons/postprocessing/Pass.js';
import { isReady, NookAO, screenMaterial, targetOf } from './ao.js';
import { excludedOf, hide, hideOthers, show } from './exclude.js';
import { defineOptions, oneOf, passRows, rows, truth, views } from './options.js';

const ownRows = {
	...passRows(Color, value => typeof value?.render === 'function'),
	normals: oneOf('depth', 'pass'),
	baked: truth(false),
	renderScene: truth(true),
	samples: { fallback: 0, valid: value => Number.isInteger(value) && value >= 0 && value <= 16, expected: 'a whole number from 0 to 16' },
};

const blend = {
	blending: CustomBlending, blendEquation: AddEquation, blendSrc: ZeroFactor, blendDst: SrcColorFactor, blendSrcAlpha: ZeroFactor, blendDstAlpha: OneFactor,
};

/** Draws colours × visibility, or one of the views. */
class Composite {
	constructor() {
		const body = `uniform sampler2D colours, visibilities, depths, normals, statics;
uniform vec3 tint;
uniform int view;
uniform bool baked, has_statics;
uniform float width, range;
out vec4 result;
float openOf(ivec2 pixel) {
	float open = texelFetch(visibilities, pixel, 0).r;
	return has_statics ? min(open, texelFetch(statics, pixel, 0).r) : open;
}
// With volumes, or baked visibility in the colours' alpha, the lowest visibility decides.
vec3 factorOf(ivec2 pixel, float alpha) {
	float open = openOf(pixel);
	if (baked) open = min(1.0, open / max(alpha, 1e-3));
	return mix(tint, vec3(1.0), open);
}`;
		const uniforms = {
			colours: null, visibilities: null, depths: null, normals: null, statics: null, has_statics: false, tint: new Color(), view: 0, baked: false, width: 1,
			range: 1,
		};
		this.whole = screenMaterial(`${body}
void main() {
	ivec2 pixel = ivec2(gl_FragCoord.xy);
	vec4 colour = texelFetch(colours, pixel, 0);
	vec3 factor = factorOf(pixel, colour.a);
	if (view == 1 || (view == 2 && gl_FragCoord.x < 0.5 * width)) factor = vec3(1.0);
	result = vec4(colour.rgb * factor, baked ? 1.0 : colour.a);
	if (view == 3) result = vec4(vec3(openOf(pixel)), 1.0);
	if (view == 4) result = vec4(texelFetch(normals, pixel, 0).rgb, 1.0);
	if (view == 5) result = vec4(vec3(min(texelFetch(depths, pixel, 0).r / range, 1.0)), 1.0);
}`, uniforms);
		this.factor = screenMaterial(`${body}\nuniform sampler2D alphas;\nvoid main() { ivec2 pixel = ivec2(gl_FragCoord.xy);
	result = vec4(factorOf(pixel, baked ? texelFetch(alphas, pixel, 0).r : 1.0), 1.0); }`, { ...uniforms, alphas: null }, blend);
		this.copy = screenMaterial('uniform sampler2D colours;\nout vec4 result;\nvoid main() { result = texelFetch(colours, ivec2(gl_FragCoord.xy), 0); }',
			{ colours: null });
		this.alpha = screenMaterial('uniform sampler2D colours;\nout float result;\nvoid main() { result = texelFetch(colours, ivec2(gl_FragCoord.xy), 0).a; }',
			{ colours: null });
		this.quad = new FullScreenQuad();
	}

	draw(renderer, material, target, values) {
		for (const [name, value] of Object.entries(values)) {
			if (material.uniforms[name]) material.uniforms[name].value = value;
		}
		const { autoClear } = renderer;
		renderer.autoClear = false;
		renderer.setRenderTarget(target);
		this.quad.material = material;
		this.quad.render(renderer);
		renderer.autoClear = autoClear;
	}

	/** Values for draw() from the options of a pass. */
	static valuesOf(pass, ao, colours, normals) {
		const statics = pass.volumes?.texture ?? null;
		return {
			colours, visibilities: ao.texture, depths: ao.depths, normals: normals ?? ao.normals, tint: pass.tint, view: views.indexOf(pass.view), baked: pass.baked,
			width: ao._size.x, range: 20 * pass.radius, statics, has_statics: statics !== null,
		};
	}

	dispose() {
		for (const one of [this.whole, this.factor, this.copy, this.alpha, this.quad]) one.dispose();
	}
}

// Properties of a material that change the normals or the outline of its surface. Colours matter only where alpha cuts holes.
const surfaceKeys = ['side', 'depthTest', 'opacity', 'alphaTest', 'alphaMap', 'bumpMap', 'bumpScale', 'normalMap', 'normalMapType', 'normalScale', 'displacementMap',
	'displacementScale', 'displacementBias', 'flatShading'];

// MeshNormalMaterial ignores alpha: adds the chunks that cut holes after two that it has.
function cutHoles(shader) {
	for (const [after, added] of [['uv_pars', ['map_pars', 'alphamap_pars', 'alphatest_pars']], ['logdepthbuf', ['map', 'alphamap', 'alphatest']]]) {
		const chunks = [after, ...added].map(name => `#include <${name}_fragment>`);
		shader.fragmentShader = shader.fragmentShader.replace(chunks[0], chunks.join('\n'));
	}
}

/** Draws the scene's depth, where no texture has it, and the normals of its materials: smooth, mapped, of both sides, with holes. */
class Prepass {
	constructor() {
		this.materials = new Map(); // material to its normals
		this.target = targetOf(UnsignedByteType);
		this.target.depthBuffer = true;
		this.target.depthTexture = new DepthTexture(1, 1, FloatType);
		this.drop = ({ target }) => {
			target.removeEventListener('dispose', this.drop);
			this.materials.get(target)?.dispose();
			this.materials.delete(target);
		};
	}

	render(renderer, scene, camera, width, height) {
		const kept = [scene.overrideMaterial, scene.background, renderer.autoClear, renderer.shadowMap.autoUpdate];
		const changed = [];
		scene.traverseVisible(object => {
			if (!object.material || invisible.includes(object.material)) return;
			changed.push([object, object.layers.mask, object.material]);
			if (!object.isMesh) object.layers.mask = 0; // lines, points and sprites have no normals
			else object.material = Array.isArray(object.material) ? object.material.map(one => this._normalsOf(one)) : this._normalsOf(object.material);
		});
		this.target.setSize(width, height);
		const clear = renderer.getClearColor(new Color()), alpha = renderer.getClearAlpha();
		renderer.setClearColor(new Color(0.5, 0.5, 0.5), 1); // no direction, as normals from depth have for sky
		scene.overrideMaterial = null;
		scene.background = null;
		renderer.autoClear = true;
		renderer.shadowMap.autoUpdate = false;
		renderer.setRenderTarget(this.target);
		renderer.render(scene, camera);
		renderer.setClearColor(clear, alpha);
		show(changed);
		[scene.overrideMaterial, scene.background, renderer.autoClear, renderer.shadowMap.autoUpdate] = kept;
	}

	dispose() {
		for (const material of [...this.materials.keys()]) this.drop({ target: material });
		this.target.depthTexture.dispose();
		this.target.dispose();
	}

	_normalsOf(material) {
		let made = this.materials.get(material);
		if (!made) {
			made = new MeshNormalMaterial();
			made.onBeforeCompile = cutHoles;
			this.materials.set(material, made);
			material.addEventListener('dispose', this.drop);
		}
		for (const key of surfaceKeys) if (material[key] !== undefined) made[key] = material[key];
		made.visible = material.visible && material.depthWrite;
		made.map = material.alphaTest > 0 ? material.map ?? null : null;
		if (made.userData.version !== material.version) made.needsUpdate = true;
		made.userData.version = material.version;
		return made;
	}
}

const owners = new WeakMap(); // buffers of composers to the pass that last wrote them
let clock = 0;

/** A pass that draws a scene with ambient obscurance, in place of a RenderPass; with renderScene: false after one. Base: a composer's Pass. */
export const passOn = Base => class extends Base {
	constructor(scene, camera, width = 512, height = 512, options = {}) {
		super('NookPass', scene, camera);
		defineOptions(this, 'NookPass', ownRows, options);
		this.scene = scene;
		this.camera = camera;
		this._ao = new NookAO(camera, width, height);
		this._composite = new Composite();
		this._prepass = null;
		this._depths = null; // of the picture that comes in, where its buffer has none
		this._frame = null;
		this._alphas = null;
		this._stamp = 0;
		this._disposed = false;
	}

	/** The visibility of the last frame, 1 where open, in the first channel; null before the first. */
	get texture() {
		return this._ao.texture;
	}

	setSize(width, height) {
		this._ao.setSize(width, height);
	}

	/** Forgets earlier frames of temporal: true. Call it after a cut of the camera. */
	reset() {
		this._ao.reset();
	}

	render(renderer, writeBuffer, readBuffer) {
		if (this._disposed) throw new Error('NookPass: found render after dispose, expected a new pass');
		const { x: width, y: height } = this._ao._size;
		if (width === 0 || height === 0 || !isReady(renderer, 'NookPass')) return;
		const before = owners.get(readBuffer);
		// A second NookPass multiplies the picture of the first one instead of drawing the scene again.
		const follows = before && before !== this && before._stamp > this._stamp && before._frame ? before : null;
		this._stamp = ++clock;
		const target = this.renderToScreen ? null : writeBuffer;
		if (target) owners.set(target, this);
		if (this.renderScene && !follows) {
			this._drawScene(renderer, target, width, height);
		} else {
			const depths = follows?._frame.depthTexture ?? this._depths ?? readBuffer.depthTexture;
			if (!depths || this.normals === 'pass') this._draw(renderer, width, height);
			if (this._obscure(renderer, depths ?? this._prepass.target.depthTexture)) this._show(renderer, readBuffer.texture, target);
		}
		renderer.setRenderTarget(target);
	}

	dispose() {
		if (this._disposed) return;
		this._disposed = true;
		this._ao.dispose();
		this._composite.dispose();
		this._prepass?.dispose();
		this._alphas?.dispose();
		this._dropFrame();
	}

	_dropFrame() {
		this._frame?.depthTexture.dispose();
		this._frame?.dispose();
		this._frame = null;
	}

	_draw(renderer, width, height) {
		this._prepass ??= new Prepass();
		this._prepass.render(renderer, this.scene, this.camera, width, height);
	}

	_obscure(renderer, depths) {
		const ao = this._ao, normals = this.normals === 'pass' ? this._prepass.target.texture : null;
		for (const name of Object.keys(rows)) ao[name] = this[name];
		ao.camera = this.camera;
		return ao.render(renderer, depths, normals) && (this.volumes === null || this.volumes.render(renderer, this.camera, ao.depths, normals ?? ao.normals));
	}

	_show(renderer, colours, target) {
		const composite = this._composite;
		const normals = this.normals === 'pass' ? this._prepass.target.texture : null;
		composite.draw(renderer, composite.whole, target, Composite.valuesOf(this, this._ao, colours, normals));
	}

	_drawScene(renderer, target, width, height) {
		if (this._frame && this._frame.samples !== this.samples) this._dropFrame();
		this._frame ??= new WebGLRenderTarget(width, height, {
			type: HalfFloatType, samples: this.samples, depthTexture: new DepthTexture(width, height, FloatType),
		});
		const frame = this._frame;
		frame.setSize(width, height);
		const { scene, camera } = this;
		const excluded = excludedOf(this);
		const kept = [renderer.autoClear, scene.background, renderer.shadowMap.autoUpdate];
		const ghosts = hide(excluded, invisible);
		renderer.autoClear = true;
		renderer.setRenderTarget(frame);
		renderer.render(scene, camera);
		if (this.normals === 'pass') this._draw(renderer, width, height);
		show(ghosts);
		this._obscure(renderer, frame.depthTexture);
		if (excluded.length === 0 || !['combined', 'off'].includes(this.view)) {
			this._show(renderer, frame.texture, target);
		} else {
			this._drawExcluded(renderer, frame, excluded);
			this._composite.draw(renderer, this._composite.copy, target, { colours: frame.texture });
		}
		[renderer.autoClear, scene.background, renderer.shadowMap.autoUpdate] = kept;
	}

	// Multiplies the frame by visibility, and draws the excluded objects over it.
	_drawExcluded(renderer, frame, excluded) {
		const { scene, camera, _composite: composite } = this;
		if (this.baked) {
			this._alphas ??= targetOf(UnsignedByteType, RedFormat);
			this._alphas.setSize(frame.width, frame.height);
			composite.draw(renderer, composite.alpha, this._alphas, { colours: frame.texture });
		}
		const values = { ...Composite.valuesOf(this, this._ao, null, null), alphas: this._alphas?.texture ?? null };
		if (this.view === 'combined') composite.draw(renderer, composite.factor, frame, values);
		const ghosts = hideOthers(scene, excluded);
		renderer.autoClear = false;
		renderer.shadowMap.autoUpdate = false;
		scene.background = null;
		renderer.setRenderTarget(frame);
		renderer.render(scene, camera);
		show(ghosts);
	}
};

export class NookPass extends /* @__PURE__ */ passOn(Pass) {}

const invisible = [0, 1, 2].map(side => new MeshBasicMaterial({ colorWrite: false, depthWrite: false, side }));
