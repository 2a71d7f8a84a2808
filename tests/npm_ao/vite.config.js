// SPDX-License-Identifier: GPL-3.0-or-later
export default { build: { target: 'es2022', rollupOptions: { input: ['index.html', 'webgpu.html'] } } };
