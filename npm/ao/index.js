// SPDX-License-Identifier: MIT
export { NookAO } from './ao.js';
export { NookPass } from './pass.js';
export { useBakedVisibility } from './baked.js';
export { NookVolumes } from './volumes.js';
