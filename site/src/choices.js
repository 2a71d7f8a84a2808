// SPDX-License-Identifier: GPL-3.0-or-later
// A row of buttons, one of which is chosen.
import { button, byId, make } from 'nook:page';

// choices: {key: text}. Draws the row again and keeps the focus in it; a row with one choice is hidden.
export function choiceBar(id, name, choices, chosen, choose, enabled = () => true) {
	const bar = byId(id), focus = bar.contains(document.activeElement) ? document.activeElement.dataset.choice : undefined;
	bar.replaceChildren();
	bar.hidden = Object.keys(choices).length < 2;
	make(bar, 'span', { class: 'name' }, name);
	for (const [key, text] of Object.entries(choices)) {
		const element = button(bar, text, key === chosen, () => choose(key), { 'data-choice': key });
		element.disabled = !enabled(key);
		if (key === focus) element.focus();
	}
}
