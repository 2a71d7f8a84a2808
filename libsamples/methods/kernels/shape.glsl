// SPDX-License-Identifier: MIT
// What artists turn last: how strong obscurance is, and a power of visibility. Fitted to rays by `nook fit`.

// Of the last pass, where nook.strength or nook.power is not 1. Open surfaces stay at 1.
float nookShaped(float open)
{
	return pow(max(0.0f, 1.0f - nook.strength * (1.0f - open)), nook.power);
}
