// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: node validate.js FILE…. Prints one line per file with the number of errors and warnings, and the message of each. Exit
// code 1: there was one.
const fs = require('fs');
const path = require('path');
const validator = require(path.join(process.cwd(), 'node_modules', 'gltf-validator'));

async function main() {
	let errors = 0;
	for (const file of process.argv.slice(2)) {
		const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 100 });
		const { numErrors, numWarnings, messages } = report.issues;
		console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings`);
		for (const message of messages.filter(found => found.severity < 2)) {
			console.log(`  ${message.code}: ${message.message} ${message.pointer || ''}`);
		}
		errors += numErrors + numWarnings;
	}
	process.exitCode = errors > 0 ? 1 : 0;
}

main();
