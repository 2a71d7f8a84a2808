// SPDX-License-Identifier: GPL-3.0-or-later
// One run that a signal may end, in a browser.
import { serve } from './calls.js';

self.onmessage = ({ data }) => serve(data, said => self.postMessage(said));
