// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause

export interface Key { key: string; words: string; act: () => void }

/// Keys work wherever nothing is being typed.
export function listen(keys: Key[]): void {
  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || target.closest?.('input:not([type=checkbox]):not([type=range]), select, textarea')) {
      return;
    }
    const key = keys.find((k) => k.key === event.key);
    if (key) {
      event.preventDefault();
      key.act();
    }
  });
}
