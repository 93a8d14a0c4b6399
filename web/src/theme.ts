// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Dark or light: as the system says, until a button says otherwise.

export class Theme {
  private chosen: boolean | null = null;
  private readonly system = matchMedia('(prefers-color-scheme: dark)');

  constructor(private readonly changed: () => void) {
    this.system.addEventListener('change', () => this.apply());
  }

  get dark(): boolean {
    return this.chosen ?? this.system.matches;
  }

  toggle(): void {
    this.chosen = !this.dark;
    this.apply();
  }

  apply(): void {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
    this.changed();
  }
}
