// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: web_volumes.mjs BROWSER SOURCE NAME…: draws the volumes NAME.glb over the G-buffer NAME.exr with npm/ao/volumes_gl.js and the
// module nook_aov.glsl in a headless browser, and compares the picture with NAME_expected.exr. Prints for each the greatest and the mean
// difference, the number of pixels beyond 1/255, and the darkest pixel.
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';

const [browser, source, ...names] = process.argv.slice(2);
const { readExr } = await import(pathToFileURL(`${source}/site/files.mjs`));
const base64 = bytes => Buffer.from(bytes.buffer ?? bytes, bytes.byteOffset, bytes.byteLength).toString('base64');
const moduleOf = name => readFileSync(`${source}/npm/ao/${name}.js`, 'utf8');

// Rows run upward in WebGL.
const flipped = (values, width, height, channels) => Float32Array.from({ length: width * height * channels }, (_, i) => {
	const texel = Math.floor(i / channels);
	return values((height - 1 - Math.floor(texel / width)) * width + texel % width, i % channels);
});

// In the page.
async function draw(file, drawing, glsl, glb, width, height, depths, normals, projection, cameraFromWorld) {
	const bytesOf = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0)), floatsOf = text => new Float32Array(bytesOf(text).buffer);
	const addressOf = text => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
	const at = addressOf(file), { readVolumes } = await import(at), { VolumesGl } = await import(addressOf(drawing.replace('./volumes_file.js', at)));
	const gl = document.createElement('canvas').getContext('webgl2');
	const textureOf = (inside, format, texels) => {
		const texture = gl.createTexture();
		gl.bindTexture(gl.TEXTURE_2D, texture);
		for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
		gl.texStorage2D(gl.TEXTURE_2D, 1, inside, width, height);
		gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format, gl.FLOAT, texels);
		return texture;
	};
	const volumes = new VolumesGl(gl, readVolumes(bytesOf(glb)), glsl);
	const view = { projection, cameraFromWorld, width, height, depths: textureOf(gl.R32F, gl.RED, floatsOf(depths)),
		normals: textureOf(gl.RGBA32F, gl.RGBA, floatsOf(normals)) };
	volumes.draw(view);
	volumes.draw(view); // again, over what the first left
	const pixels = new Uint8Array(4 * width * height);
	gl.bindFramebuffer(gl.FRAMEBUFFER, volumes.targets[1].frame);
	gl.bindBuffer(gl.PIXEL_PACK_BUFFER, gl.createBuffer()); // reading without one stalls, which the console reports
	gl.bufferData(gl.PIXEL_PACK_BUFFER, pixels.length, gl.STREAM_READ);
	gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
	const drawn = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
	for (gl.flush(); gl.clientWaitSync(drawn, 0, 0) === gl.TIMEOUT_EXPIRED;) await new Promise(later => setTimeout(later, 10));
	gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, pixels);
	const faults = [gl.getError()];
	volumes.dispose();
	volumes.dispose(); // twice is harmless
	faults.push(gl.getError());
	return { faults, values: Array.from({ length: width * height }, (_, i) => pixels[4 * ((height - 1 - Math.floor(i / width)) * width + i % width)] / 255) };
}

writeFileSync('page.html', '<!doctype html>\n');
for (const name of names) {
	const { width, height, channels, attributes } = readExr(`${name}.exr`);
	const depths = flipped(at => (channels.Z[at] < 1e30 ? channels.Z[at] : 1e30), width, height, 1);
	const normals = flipped((at, channel) => (channel < 3 ? channels[`N.${'XYZ'[channel]}`][at] : 0), width, height, 4);
	const values = [moduleOf('volumes_file'), moduleOf('volumes_gl'), readFileSync('nook_aov.glsl', 'utf8'), base64(readFileSync(`${name}.glb`)), width, height, base64(depths), base64(normals),
		attributes.projection64, attributes.worldToCamera64 ?? attributes.worldToCamera];
	const script = `return await (${draw})(${values.map(value => JSON.stringify(value)).join(', ')});`;
	const { status, stdout, stderr } = spawnSync('node', [`${source}/tests/page_driver.cjs`, browser, 'page.html'], { input: script, encoding: 'utf8', maxBuffer: 1 << 28 });
	if (status !== 0) {
		console.log(`${name} error ${status} ${stderr.split('\n')[0]}`);
		continue;
	}
	const { faults, values: found } = JSON.parse(stdout), expected = readExr(`${name}_expected.exr`).channels.visibility;
	const apart = found.map((value, i) => Math.abs(value - expected[i]));
	const mean = apart.reduce((sum, one) => sum + one, 0) / apart.length, dark = Math.min(...expected);
	if (faults.some(fault => fault !== 0)) console.log(`${name} error: WebGL ${faults}`);
	else console.log(`${name} ${Math.max(...apart).toFixed(4)} ${mean.toFixed(6)} ${apart.filter(one => !(one <= 1 / 255)).length} pixels beyond, darkest ${dark.toFixed(3)}`);
}
