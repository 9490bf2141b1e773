// Draws a shape with fewer pixels while it moves, where a page without a graphics processor would fall
// behind the hand, and with all of them as soon as it stays.

const FRAME = 16; // ms: a page that draws within a frame of the screen draws all pixels
const SHARE = 0.5; // of the pixels along each side, as in the live page
const REST = 200; // ms after the last move

export class Detail {
  #views;
  /** @type {Map<any, number>} three.js's renderers that draw less, and the pixels a CSS pixel had */
  #less = new Map();
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;

  /** @param {() => Promise<any>[]} views pythreejs's of what is drawn */
  constructor(views) {
    this.#views = views;
  }

  /**
   * A shape has moved.
   *
   * @param {number} drawingTime milliseconds that a drawing with all pixels takes; 0 while unknown
   */
  moved(drawingTime) {
    if (drawingTime <= FRAME) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.restore(), REST);
    for (const one of this.#views()) void one.then((view) => this.#reduce(view));
  }

  /** Draws all pixels again. */
  restore() {
    clearTimeout(this.#timer);
    for (const [renderer, ratio] of this.#less) renderer.setPixelRatio(ratio);
    if (this.#less.size) for (const one of this.#views()) void one.then(draw);
    this.#less.clear();
  }

  /** @param {any} view pythreejs's */
  #reduce(view) {
    const { renderer } = view;
    if (!renderer || this.#less.has(renderer)) return;
    const ratio = renderer.getPixelRatio();
    this.#less.set(renderer, ratio);
    renderer.setPixelRatio(SHARE * ratio);
    draw(view); // a changed canvas is empty
  }
}

/** @param {any} view pythreejs's */
function draw(view) {
  if (view.renderer && !view.isFrozen) view.renderScene();
}
