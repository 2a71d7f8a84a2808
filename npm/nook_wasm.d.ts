// SPDX-License-Identifier: GPL-3.0-or-later
/** The address of nook.wasm, by a bundler's loader of files: load(source). */
declare const source: string;
export default source;
