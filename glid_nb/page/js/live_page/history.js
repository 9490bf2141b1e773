// Undo and redo of values. All changes of one gesture are one step.

/** @template T */
export class History {
  /** @type {T[]} */
  #past = [];
  /** @type {T[]} */
  #future = [];

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  /**
   * Notes the state before a change.
   * @param {T} before
   */
  note(before) {
    this.#past.push(before);
    this.#future = [];
  }

  /**
   * Forgets the last step; returns the state before it.
   * @returns {T | undefined}
   */
  drop() {
    return this.#past.pop();
  }

  /**
   * @param {T} now
   * @returns {T | undefined} the state to go back to
   */
  undo(now) {
    const before = this.#past.pop();
    if (before !== undefined) this.#future.push(now);
    return before;
  }

  /**
   * @param {T} now
   * @returns {T | undefined}
   */
  redo(now) {
    const after = this.#future.pop();
    if (after !== undefined) this.#past.push(now);
    return after;
  }
}
