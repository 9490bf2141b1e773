// The timeline below the canvas: keyframes with thumbnails, what is proved between them, a playhead.

import { Motion } from "../motion/motion.js";
import { follow, make, toFloats } from "../pad/dom.js";
import { icon, iconButton } from "../pad/icons.js";
import { Link } from "../pad/link.js";
import { undoOrRedo } from "../pad/keys.js";
import { Player } from "./player.js";

const EASINGS = [
  ["linear", "Even"],
  ["in", "Ease in"],
  ["out", "Ease out"],
  ["in-out", "Ease in, out"],
];
const REPEATS = [
  ["once", "Once"],
  ["loop", "Loop"],
  ["ping-pong", "Ping-pong"],
];
const STEP = 1 / 30;
const NUDGE = 0.1; // seconds of the arrow keys, alone and with Alt
const SNAP = 6;
const STILL = 4;
const SLIM = 8; // CSS pixels
const LATER = 1.15; // room behind the last keyframe, to drag it there
const KERNEL = "Played by the kernel (too large for shaders). ";

const seconds = (time) => `${time.toFixed(2)} s`;

function menu(label, rows, act) {
  const look = { "aria-label": label, title: label, onchange: (e) => act(e.target.value) };
  return make("select", look, ...rows.map(([value, text]) => new Option(text, value)));
}

function render({ model, el, signal }) {
  const shown = () => model.get("shown");
  let stage = null;
  let hovered = "";
  let span = 1;
  let drag = null;
  let layers = null;
  const whole = { className: "glid-skin glid-timeline", role: "group", "aria-label": "Timeline" };
  const root = make("div", whole);
  const link = new Link(model, root, signal, () => tell());
  const act = (type, content = {}) => link.put({ type, ...content });
  const player = new Player(
    (floats, time) => {
      const shows = time === undefined ? null : (floats ?? true);
      stage?.trigger("glid:motion", shows, release, shows && (layers?.at(time) ?? null));
      if (shown().kernel && stage) return act("frame", { time: time ?? null, replaces: "frame" });
    },
    () => showHead(),
  );
  const active = () => shown().keyframes[shown().active];
  const release = () => player.release(active().time);
  const atKey = (time) => shown().keyframes.findIndex((key) => Math.abs(key.time - time) < 1e-9);
  const select = (index) => {
    if (index === shown().active) release();
    else act("go_to_pose", { index });
  };
  const edit = (type, content = {}) => act(type, { index: shown().active, ...content });

  const play = iconButton("play", "Play, pause (Space)", () => player.play());
  const repeat = menu("Play once, in a loop, or there and back", REPEATS, (value) =>
    act("set_repeat", { repeat: value }),
  );
  const clock = make("span", { className: "glid-time", role: "timer" });
  const record = iconButton("record", "Record: keep the next drag as keyframes", () =>
    act("record", { on: !shown().recording }),
  );
  const onion = iconButton(
    "onion",
    "Onion skin of the pose that is edited: outlines of those before (blue) and after (orange)",
    () => act("onion", { on: !shown().onion }),
  );
  const keep = make("button", {
    className: "glid-keep",
    title: "Keep this pose and go on with a copy; between poses, keep what is seen",
    onclick: () => act("keep", { time: player.seen ? player.place : active().time }),
  });
  const copy = iconButton("copy", "Duplicate this pose", () => edit("duplicate_pose"));
  const remove = iconButton("trash", "Delete this pose (Delete)", () => edit("delete_pose"));
  const name = make("input", {
    type: "text",
    "aria-label": "Name of the pose",
    title: "Name of the pose",
    maxLength: 200,
    onchange: () => edit("rename_pose", { name: name.value }),
  });
  const easing = menu("How the motion leaves this pose", EASINGS, (value) =>
    edit("set_easing", { easing: value }),
  );
  const save = iconButton("export", "Export the motion", () => act("export"));
  const gap = () => make("span", { className: "glid-gap" });
  const bar = make(
    "div",
    { className: "glid-bar", role: "toolbar", "aria-label": "Motion" },
    play,
    repeat,
    clock,
    gap(),
    record,
    onion,
    gap(),
    keep,
    copy,
    remove,
    name,
    easing,
    save,
  );
  const ruler = make("div", {
    className: "glid-ruler",
    tabIndex: 0,
    role: "slider",
    "aria-label": "Time",
    "aria-valuemin": 0,
  });
  const keys = make("div", { className: "glid-keys" });
  const strip = make("div", {
    className: "glid-strip",
    role: "img",
    onpointerleave: () => hover(""),
  });
  const head = make("div", { className: "glid-playhead" });
  const track = make("div", { className: "glid-track" }, ruler, keys, strip, head);
  const note = make("div", {
    className: "glid-timeline-note",
    role: "status",
    "aria-live": "polite",
  });
  root.append(bar, track, note);
  root.dataset.lmSuppressShortcuts = "true"; // JupyterLab must not take the keys first
  el.classList.add("glid-host");
  el.append(root);

  const wide = (time) => `${time / span} * (100% - 2 * var(--glid-inset))`;
  const at = (time) => `calc(var(--glid-inset) + ${wide(time)})`;
  const inside = () => {
    const { left, width } = track.getBoundingClientRect();
    const inset = parseFloat(getComputedStyle(root).getPropertyValue("--glid-inset"));
    return { left: left + inset, width: width - 2 * inset };
  };

  function tell() {
    const { keyframes, recording, kernel } = shown();
    const { spans } = model.get("motion");
    const bad = spans.find(({ reason }) => reason);
    const least = Math.min(...spans.flatMap(({ sigma2 }) => sigma2));
    let text = keyframes.length < 2 ? "Keep a second pose to see what lies between." : "";
    if (recording) text = "Recording: drag a pin; what it does becomes keyframes.";
    else if (bad) text = bad.reason;
    else if (spans.some(({ status }) => status === "computing"))
      text = "Proving what lies between…";
    else if (spans.length)
      text = `Proved at every instant of ${seconds(spans.at(-1).end - spans[0].start)}: σ₂ ≥ ${least.toFixed(3)}.`;
    if (kernel && spans.length && !bad) text = KERNEL + text;
    note.title = note.textContent = link.refusal || hovered || text;
    note.dataset.tone = link.refusal || (bad && !hovered) ? "bad" : "";
  }

  function hover(text) {
    hovered = text;
    tell();
  }

  function showHead() {
    if (!shown().keyframes) return;
    const { place, seen, playing } = player;
    const { keyframes } = shown();
    const end = model.get("motion").spans.at(-1)?.end ?? keyframes.at(-1).time;
    head.style.left = at(place);
    head.classList.toggle("glid-seen", seen);
    const does = playing ? "pause" : "play";
    if (play.dataset.does !== does) play.innerHTML = icon(does);
    play.dataset.does = does;
    clock.textContent = `${place.toFixed(2)} / ${seconds(end)}`;
    Object.assign(track.dataset, { time: place, span });
    ruler.setAttribute("aria-valuenow", place.toFixed(2));
    ruler.setAttribute("aria-valuetext", seconds(place));
    keep.textContent = seen && atKey(place) < 0 ? "Keep it" : "Keep";
  }

  function showKeys() {
    if (drag) return; // what the pointer holds must stay in the page
    const { keyframes, active: index, repeat: repeats, back } = shown();
    const thumbnails = model.get("thumbnails");
    const ends =
      repeats === "loop" && keyframes.length > 1
        ? [
            {
              ...keyframes[0],
              time: keyframes.at(-1).time + back,
              name: `Back to ${keyframes[0].name}`,
            },
          ]
        : [];
    const all = [...keyframes, ...ends];
    const room = (i) =>
      Math.min(
        ...[i, i + 1].map((j) => (all[j - 1] && all[j] ? all[j].time - all[j - 1].time : span)),
      );
    span = Math.max(1, all.at(-1).time) * LATER;
    ruler.setAttribute("aria-valuemax", span.toFixed(2));
    const focused = [...keys.children].indexOf(keys.getRootNode().activeElement);
    keys.replaceChildren(
      ...all.map((key, i) => {
        const picture = thumbnails[key.thumbnail];
        const title = `${key.name} at ${seconds(key.time)}`;
        return make(
          "button",
          {
            className: i < keyframes.length ? "glid-key" : "glid-key glid-return",
            title: `${title}; drag it to another time`,
            "aria-label": title,
            "aria-pressed": i === index,
            style: `left: ${at(key.time)}; width: clamp(${SLIM}px, ${wide(room(i))} - 2px, 60px)`,
            onpointerdown: (e) => grab(e, i),
            onclick: (e) => e.detail || select(i % keyframes.length),
          },
          ...(picture ? [make("img", { src: picture, alt: "", draggable: false })] : []),
        );
      }),
    );
    keys.children[focused]?.focus();
  }

  function showSpans() {
    const { spans } = model.get("motion");
    const part = (start, end, kind, text, height = 1) =>
      make("div", {
        className: `glid-piece glid-${kind}`,
        title: text,
        onpointerenter: () => hover(text),
        style: `left: ${at(start)}; width: calc(${wide(end - start)}); --glid-height: ${height}`,
      });
    strip.replaceChildren(
      ...spans.flatMap(({ start, end, status, reason, times, sigma2 }) => {
        const proved = sigma2.map((value, i) =>
          part(
            times[i],
            times[i + 1],
            "proved",
            `σ₂ ≥ ${value.toFixed(3)} from ${seconds(times[i])} to ${seconds(times[i + 1])}`,
            Math.min(Math.max(value, 0.06), 1),
          ),
        );
        const from = status === "fails" ? times.at(-1) : start;
        const rest =
          status === "proved"
            ? []
            : [
                part(
                  from,
                  end,
                  status,
                  reason || `Not proved yet from ${seconds(start)} to ${seconds(end)}`,
                ),
              ];
        return [...proved, ...rest];
      }),
    );
    const every =
      [0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 300, 600].find((step) => span / step <= 12) ?? 1800;
    ruler.replaceChildren(
      ...Array.from({ length: Math.floor(span / every) + 1 }, (_, i) =>
        make("span", { style: `left: ${at(i * every)}` }, `${Number((i * every).toFixed(1))}`),
      ),
    );
    strip.setAttribute("aria-label", note.textContent);
  }

  function showState() {
    const {
      keyframes,
      active: index,
      repeat: repeats,
      recording,
      onion: on,
      exports: exported,
    } = shown();
    const moved = root.dataset.active !== `${index}/${keyframes.length}`;
    root.dataset.active = `${index}/${keyframes.length}`;
    repeat.value = repeats;
    easing.value = active().easing;
    if (document.activeElement !== name || moved) name.value = active().name;
    remove.disabled = keyframes.length === 1;
    play.disabled = save.disabled = repeat.disabled = easing.disabled = keyframes.length < 2;
    save.hidden = !exported;
    record.ariaPressed = recording;
    onion.ariaPressed = on;
    showKeys();
    showMotion();
    if (moved || !player.seen) release();
  }

  function showMotion() {
    const { spans } = model.get("motion");
    player.set(
      spans.map((one) => ({ ...one, floats: toFloats(one.floats) })),
      shown().repeat,
    );
    if (
      shown().kernel &&
      !player.playing &&
      player.seen &&
      spans.some(({ status }) => status === "computing")
    )
      release();
    tell();
    showSpans();
    showHead();
  }

  function showHeights() {
    const { times, floats } = model.get("heights");
    layers = times.length ? new Motion({ times, repeat: "once" }, toFloats(floats)) : null;
  }

  // The time nearest to one at which a keyframe, or a loop's return, can be told from the others.
  function landing(index, time) {
    const { keyframes } = shown();
    const others = keyframes.filter((_, i) => i !== index).map((key) => key.time);
    const gap = Math.ceil(100 * (SLIM / inside().width) * span) / 100;
    const least = index < keyframes.length ? 0 : others.at(-1) + gap;
    const free = (t) => t >= least && others.every((other) => Math.abs(t - other) > gap - 0.006);
    const places = [
      Math.max(time, least),
      ...others.flatMap((other) => [other - gap, other + gap]),
    ].map((t) => Math.round(100 * t) / 100);
    return places.filter(free).sort((a, b) => Math.abs(a - time) - Math.abs(b - time))[0];
  }

  // A keyframe is dragged along time, or clicked.
  function grab(e, index) {
    if (e.button !== 0) return;
    e.stopPropagation();
    const button = e.currentTarget;
    const { keyframes, back } = shown();
    const count = keyframes.length;
    const from = index < count ? keyframes[index].time : keyframes.at(-1).time + back;
    drag = { x: e.clientX, moved: false };
    button.setPointerCapture(e.pointerId);
    button.focus({ preventScroll: true }); // so that Escape is heard
    button.onpointermove = (move) => {
      drag.moved ||= Math.abs(move.clientX - drag.x) > STILL;
      if (!drag.moved) return;
      drag.time = landing(index, from + ((move.clientX - drag.x) / inside().width) * span);
      button.style.left = head.style.left = at(drag.time);
      hover(`to ${seconds(drag.time)}`);
    };
    button.onlostpointercapture = () => {
      if (!drag) return;
      const { moved, time } = drag;
      drop();
      if (moved) ruler.focus({ preventScroll: true });
      if (moved) act("move_pose", { index, time });
      else if (index < count) select(index);
    };
  }

  function drop() {
    drag = null;
    hover("");
    showKeys();
    showHead();
  }

  // Elsewhere a pointer scrubs; it snaps to keyframes.
  function scrub(e) {
    if (drag?.scrubs !== e.pointerId) return;
    const { left, width } = inside();
    const time = ((e.clientX - left) / width) * span;
    const near = (SNAP / width) * span;
    const key = shown().keyframes.find((one) => Math.abs(one.time - time) < near);
    player.scrub(key?.time ?? time);
  }
  track.addEventListener("pointerdown", (e) => {
    if (e.button !== 0 || !player.clock) return;
    drag = { scrubs: e.pointerId };
    track.setPointerCapture(e.pointerId);
    scrub(e);
  });
  track.addEventListener("pointermove", scrub);
  track.addEventListener("lostpointercapture", (e) => {
    if (drag?.scrubs !== e.pointerId) return;
    drop();
    if (atKey(player.place) >= 0) select(atKey(player.place));
  });

  function step(e) {
    const sign = e.key === "ArrowLeft" ? -1 : 1;
    const { keyframes, active: index } = shown();
    if (e.altKey) return edit("move_pose", { time: landing(index, active().time + sign * NUDGE) });
    if (!e.shiftKey) return player.scrub(player.place + sign * STEP);
    const time = player.place;
    const order = keyframes
      .map((key, i) => [key.time, i])
      .filter(([t]) => sign * (t - time) > 1e-9);
    select((sign > 0 ? order[0] : order.at(-1))?.[1] ?? index);
  }
  const KEYS = {
    " ": () => player.play(),
    ArrowLeft: step,
    ArrowRight: step,
    Delete: () => edit("delete_pose"),
    Backspace: () => edit("delete_pose"),
    Home: () => select(0),
    End: () => select(shown().keyframes.length - 1),
    Escape: () => {
      drop();
      release();
    },
  };
  root.addEventListener("keydown", (e) => {
    const typing = bar.contains(e.target);
    if (undoOrRedo(e) && e.target !== name) act(undoOrRedo(e));
    else if (e.ctrlKey || e.metaKey) return;
    else if (!typing && KEYS[e.key]) (e.repeat && e.key === " ") || KEYS[e.key](e);
    else return e.stopPropagation();
    e.preventDefault();
    e.stopPropagation();
  });
  root.addEventListener(
    "keyup",
    (e) => e.key === " " && !bar.contains(e.target) && e.preventDefault(),
  );
  // After a click on a button the keys are the timeline's again.
  bar.addEventListener(
    "click",
    (e) => e.detail && e.target.closest("button") && ruler.focus({ preventScroll: true }),
  );
  // A tap on the space bar over the canvas of the same editor plays too.
  const tapped = (e) => {
    if (e.target.closest(".glid-editor") === el.closest(".glid-editor")) player.play();
  };
  window.addEventListener("glid:play", tapped, { signal });

  const edited = () => player.seen && release();
  follow(model, {
    "change:shown": showState,
    "change:motion": showMotion,
    "change:heights": showHeights,
    "change:thumbnails": showKeys,
  });
  model.widget_manager.get_model(model.get("stage")).then((found) => {
    if (signal.aborted) return;
    stage = found;
    stage.on("change:coefficients", edited);
  });

  return () => {
    player.pause();
    stage?.off("change:coefficients", edited);
  };
}

export default { render };
