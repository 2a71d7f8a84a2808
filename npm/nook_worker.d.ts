// SPDX-License-Identifier: GPL-3.0-or-later
/** A script to start a worker with; nothing to import. */
export {};
