// SPDX-License-Identifier: MIT
// The final adjustment: strength of the obscurance, and an exponent of the visibility.

// Applies nook.strength to the obscurance, which is 1 - open, then nook.power to the visibility. Fully open surfaces stay at 1.
float nookShaped(float open)
{
	return pow(max(0.0f, 1.0f - nook.strength * (1.0f - open)), nook.power);
}
