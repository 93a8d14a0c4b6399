// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Elements without markup: whatever a run is called, its name is text.

type Child = Node | string | null | undefined;
type Properties = Record<string, string | number | boolean | ((event: never) => void) | undefined>;

/// make('button', {class: 'small', onclick: f, 'aria-label': 'x'}, 'text', child)
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, properties: Properties = {}, ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (typeof value === 'function') {
      element.addEventListener(name.slice(2), value as unknown as EventListener);
    } else if (value === true) {
      element.setAttribute(name, '');
    } else if (value !== undefined && value !== false) {
      element.setAttribute(name, String(value));
    }
  }
  element.append(...children.filter((c): c is Node | string => c !== null && c !== undefined));
  return element;
}

export function select(label: string, options: [string, string][], change: (value: string) => void): HTMLSelectElement {
  const element = make('select', { 'aria-label': label, title: label },
    ...options.map(([value, text]) => make('option', { value }, text)));
  element.addEventListener('change', () => change(element.value));
  return element;
}

export function checkbox(label: string, checked: boolean, change: (value: boolean) => void): HTMLLabelElement {
  const box = make('input', { type: 'checkbox', checked });
  box.addEventListener('change', () => change(box.checked));
  return make('label', { class: 'check' }, box, label);
}

/// Hands a file to the person.
export function save(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  make('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

export function fixed(value: number, decimals: number): string {
  return Number.isFinite(value) ? value.toFixed(decimals) : '–';
}

/// 0.000123 as "0.00012", 12345 as "12345".
export function brief(value: number): string {
  if (!Number.isFinite(value)) { return '–'; }
  const size = Math.abs(value);
  return size >= 1000 ? value.toFixed(0) : size === 0 ? '0' : size >= 1 ? value.toFixed(2) : value.toPrecision(2);
}

export function metres(value: number): string {
  return Math.abs(value) >= 1000 ? `${fixed(value / 1000, 2)} km` : `${fixed(value, value >= 100 ? 0 : 2)} m`;
}
