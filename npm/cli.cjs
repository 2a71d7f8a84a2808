#!/usr/bin/env node
// SPDX-License-Identifier: GPL-3.0-or-later
// npx nook-patterns pattern --domain disk --count 9 -o disk.json: the program's own arguments, files and exit codes.
'use strict';

delete globalThis.fetch; // Emscripten would ask it for the file beside this one
require('./nook.cjs');
