// SPDX-License-Identifier: GPL-3.0-or-later
// One run that a signal may end, in Node.js.
import { parentPort } from 'node:worker_threads';

import { serve } from './calls.js';

parentPort.on('message', message => serve(message, said => parentPort.postMessage(said)));
