
"use strict";
// The viewer of a report. The page shows all pictures without it; see comparison_report.h.
(() => {
  const modes = [
    { key: "side", label: "Side by side" },
    { key: "slider", label: "Slider" },
    { key: "blink", label: "Blink" },
    { key: "difference", label: "Difference" },
    { key: "flip", label: "Perceived" },
    { key: "windows", label: "8 × 8 means" },
  ];
  const most_scale = 64;
  const blink_ms = 500;   // two changes a second: far from three flashes
  const reduced_motion = matchMedia("(prefers-reduced-motion: reduce)");

  // What stays from image to image.
  const chosen = { mode: "side", gain: 8, split: 0.5, verdict: "" };

  function element(name, properties = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(properties)) {
      if (key.includes("-") || key === "role" || key === "for") made.setAttribute(key, value);
      else made[key] = value;
    }
    made.append(...children);
    return made;
  }

  function button(text, label, click) {
    const made = element("button", { type: "button", textContent: text, onclick: click });
    if (label) made.setAttribute("aria-label", label);
    return made;
  }

  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  function pixels_of(image) {
    const canvas = element("canvas", { width: image.naturalWidth, height: image.naturalHeight });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
  }

  /** The pictures of one image, in one of the modes. */
  class Viewer {
    constructor(pictures) {
      this.pictures = pictures;
      this.sources = {};
      for (const figure of pictures.querySelectorAll("figure")) this.sources[figure.dataset.role] = figure.querySelector("img");
      const side = (name) => Math.max(1, ...Object.values(this.sources).map((image) => Number(image.getAttribute(name))));
      this.width = side("width");
      this.height = side("height");
      const [x, y, w, h] = pictures.dataset.changed.split(" ").map(Number);
      this.changed = w > 0 ? { x, y, w, h } : null;
      this.hottest = pictures.dataset.hottest;
      this.comparable = Boolean(this.sources.reference && this.sources.image && this.sources.flip);
      this.stages = [];
      this.pointers = new Map();
      this.build();
    }

    modes() {
      if (this.comparable) return modes;
      return modes.filter((mode) => mode.key === "side" || (mode.key === "difference" && this.sources.difference));
    }

    mode() {
      return this.modes().some((mode) => mode.key === chosen.mode) ? chosen.mode : "side";
    }

    build() {
      this.mode_buttons = this.modes().map((mode) => {
        const made = button(mode.label, "", () => this.set_mode(mode.key));
        made.dataset.mode = mode.key;
        return made;
      });
      this.zoom_text = element("output", { "aria-label": "Zoom" });
      const zoom = element("div", { className: "zoom", role: "group", "aria-label": "Zoom" },
        button("−", "Zoom out", () => this.zoom_by(0.5)), this.zoom_text, button("+", "Zoom in", () => this.zoom_by(2)),
        button("Fit", "Fit the picture", () => this.fit()));
      if (this.changed) zoom.append(button("Change", "Change: zoom to the changed region", () => this.zoom_to_change()));
      this.options = element("div", { className: "options" });
      this.stage_row = element("div", { className: "stages" });
      this.readout = element("p", { className: "readout" });
      const tools = element("div", { className: "tools" });
      if (this.mode_buttons.length > 1) tools.append(element("div", { className: "segments", role: "group", "aria-label": "View" }, ...this.mode_buttons));
      tools.append(zoom);
      this.root = element("div", { className: "viewer" }, tools, this.options, this.stage_row, this.readout);
      for (const figure of this.pictures.children) figure.hidden = true;
      this.pictures.classList.remove("pictures");
      this.pictures.append(this.root);
      this.resized = new ResizeObserver(() => this.resize());
      this.resized.observe(this.stage_row);
      this.set_mode(this.mode());
    }

    set_mode(key) {
      chosen.mode = key;
      for (const made of this.mode_buttons) made.setAttribute("aria-pressed", String(made.dataset.mode === this.mode()));
      this.stop();
      this.stages = [];
      this.stage_row.replaceChildren();
      this.options.replaceChildren();
      this[`show_${this.mode()}`]();
      this.options.hidden = this.options.childElementCount === 0;
      this.stage_row.classList.toggle("two", this.stages.length === 2);
      this.apply();
    }

    /** A picture frame; all frames show the same part. */
    add_stage(label, tag, ...contents) {
      const layer = element("div", { className: "layer" }, ...contents);
      layer.style.width = `${contents[0].dataset.width ?? this.width}px`;
      layer.style.height = `${contents[0].dataset.height ?? this.height}px`;
      if (this.changed) layer.append(this.mark());
      const stage = element("div", {
        className: "stage", tabIndex: 0, role: "group", "aria-roledescription": "picture",
        "aria-label": `${label}. Arrow keys move the picture, plus and minus zoom.`,
      }, layer);
      if (tag) stage.append(element("span", { className: "tag", textContent: tag }));
      stage.style.aspectRatio = `${this.width} / ${this.height}`;
      this.listen(stage);
      this.stages.push({ stage, layer });
      this.stage_row.append(stage);
      return stage;
    }

    mark() {
      const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      svg.setAttribute("class", "mark");
      svg.setAttribute("viewBox", `0 0 ${this.width} ${this.height}`);
      svg.setAttribute("aria-hidden", "true");
      const rectangle = document.createElementNS("http://www.w3.org/2000/svg", "rect");
      const margin = 0.5;
      for (const [key, value] of Object.entries({ x: this.changed.x - margin, y: this.changed.y - margin,
        width: this.changed.w + 2 * margin, height: this.changed.h + 2 * margin })) rectangle.setAttribute(key, value);
      svg.append(rectangle);
      return svg;
    }

    copy(role) {
      const source = this.sources[role];
      return element("img", {
        src: source.src, alt: source.alt, draggable: false, "data-width": source.getAttribute("width"), "data-height": source.getAttribute("height"),
      });
    }

    show_side() {
      for (const [role, tag] of [["reference", "Reference"], ["image", "Image"]]) {
        if (this.sources[role]) this.add_stage(tag, tag, this.copy(role));
      }
    }

    show_slider() {
      const above = this.copy("image");
      const stage = this.add_stage("Reference at the left, image at the right", "Reference", this.copy("reference"), above);
      stage.append(element("span", { className: "tag right", textContent: "Image" }));
      const handle = element("div", {
        className: "handle", tabIndex: 0, role: "slider", "aria-label": "Border between reference and image",
        "aria-valuemin": "0", "aria-valuemax": "100",
      });
      stage.append(handle);
      this.place_split = () => {
        const place = this.view();
        const at = chosen.split * stage.clientWidth;
        handle.style.left = `${at}px`;
        handle.setAttribute("aria-valuenow", String(Math.round(100 * chosen.split)));
        const column = (at - place.left(stage)) / place.scale;
        above.style.clipPath = `inset(0 0 0 ${clamp(column, 0, this.width)}px)`;
      };
      const move = (event) => {
        const box = stage.getBoundingClientRect();
        chosen.split = clamp((event.clientX - box.left) / box.width, 0, 1);
        this.place_split();
      };
      handle.onpointerdown = (event) => {
        handle.setPointerCapture(event.pointerId);
        event.stopPropagation();
      };
      handle.onpointermove = (event) => {
        event.stopPropagation();
        if (handle.hasPointerCapture(event.pointerId)) move(event);
      };
      handle.onkeydown = (event) => {
        const step = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.2, PageUp: 0.2, Home: -1, End: 1 }[event.key];
        if (!step) return;
        event.preventDefault();
        event.stopPropagation();
        chosen.split = clamp(chosen.split + step, 0, 1);
        this.place_split();
      };
    }

    show_blink() {
      const above = this.copy("image");
      const stage = this.add_stage("Reference and image in turn", "Reference", this.copy("reference"), above);
      const tag = stage.querySelector(".tag");
      above.hidden = true;
      this.swap = () => {
        above.hidden = !above.hidden;
        tag.textContent = above.hidden ? "Reference" : "Image";
      };
      const play = button("", "", () => (this.timer ? this.stop() : this.start()));
      this.play_text = () => (play.textContent = this.timer ? "Pause" : "Play");
      this.options.append(play, button("Swap", "Swap reference and image", () => {
        this.stop();
        this.swap();
      }), element("span", { textContent: "Space swaps the pictures." }));
      if (!reduced_motion.matches) this.start();
      this.play_text();
    }

    start() {
      this.timer = setInterval(() => this.swap(), blink_ms);
      this.play_text?.();
    }

    stop() {
      clearInterval(this.timer);
      this.timer = 0;
      this.play_text?.();
    }

    show_difference() {
      if (!this.comparable) {
        this.add_stage("Difference of pictures of two sizes", "Difference", this.copy("difference"));
        this.options.append(element("span", { textContent: "Yellow: the reference alone. Green: the image alone." }));
        return;
      }
      const canvas = element("canvas", { width: this.width, height: this.height });
      this.add_stage("Difference of both pictures in each channel", "Difference", canvas);
      const select = element("select", { id: "gain" });
      for (const gain of [1, 4, 8, 16, 64]) select.append(element("option", { value: gain, textContent: `× ${gain}`, selected: gain === chosen.gain }));
      const draw = async () => {
        const pair = await this.pixels();
        if (pair) draw_difference(canvas, pair, chosen.gain);
      };
      select.onchange = () => {
        chosen.gain = Number(select.value);
        draw();
      };
      this.options.append(element("label", { for: "gain", textContent: "Gain" }), select,
        element("span", { textContent: "Black where both pictures are equal." }));
      draw();
    }

    show_flip() {
      this.add_stage("Perceived difference (FLIP)", "Perceived difference (FLIP)", this.copy("flip"));
      this.add_scale("0", "1");
    }

    show_windows() {
      this.add_stage("Mean difference of 8 × 8 pixels", "Mean difference of 8 × 8 pixels", this.copy("windows"));
      this.add_scale("0", `${this.hottest} levels`);
    }

    add_scale(cold, hot) {
      this.options.append(element("span", { textContent: cold }), element("span", { className: "scale", role: "img", "aria-label": "Scale from black over purple and orange to yellow" }),
        element("span", { textContent: hot }));
    }

    /** Both pictures as bytes, read once. */
    async pixels() {
      if (!this.comparable) return null;
      if (!this.pixel_data) {
        const images = ["reference", "image"].map((role) => this.copy(role));
        await Promise.all(images.map((image) => image.decode()));
        this.pixel_data = images.map(pixels_of);
      }
      return this.pixel_data;
    }

    // The view: a point of the picture at the middle of each frame, and a scale. Without one the picture fits.
    fit_scale() {
      const { stage } = this.stages[0];
      const scale = Math.min(stage.clientWidth / this.width, stage.clientHeight / this.height);
      return scale >= 2 ? Math.floor(scale) : scale || 1;
    }

    view() {
      const free = this.free;
      const scale = free ? free.scale : this.fit_scale();
      const x = free ? free.x : this.width / 2, y = free ? free.y : this.height / 2;
      return { scale, x, y, left: (stage) => stage.clientWidth / 2 - x * scale, top: (stage) => stage.clientHeight / 2 - y * scale };
    }

    apply() {
      if (!this.stages.length || !this.stages[0].stage.clientWidth) return;
      const view = this.view();
      for (const { stage, layer } of this.stages) {
        layer.style.transform = `translate(${view.left(stage)}px, ${view.top(stage)}px) scale(${view.scale})`;
        layer.classList.toggle("pixels", view.scale >= 1);
        layer.style.setProperty("--stroke", `${1.5 / view.scale}px`);
        stage.classList.toggle("near", Boolean(this.free));
      }
      this.zoom_text.textContent = `${Math.round(100 * view.scale)} %`;
      if (this.mode() === "slider") this.place_split();
    }

    resize() {
      this.apply();
    }

    fit() {
      this.free = null;
      this.apply();
    }

    /** Keeps the picture's point (x, y) where it is. */
    zoom_by(factor, x, y) {
      const view = this.view();
      const scale = clamp(view.scale * factor, Math.min(0.05, this.fit_scale()), most_scale);
      const keep = { x: x ?? view.x, y: y ?? view.y };
      const part = view.scale / scale;
      this.free = { scale, x: keep.x + (view.x - keep.x) * part, y: keep.y + (view.y - keep.y) * part };
      this.bound();
    }

    bound() {
      this.free.x = clamp(this.free.x, 0, this.width);
      this.free.y = clamp(this.free.y, 0, this.height);
      this.apply();
    }

    zoom_to(x, y, w, h) {
      const { stage } = this.stages[0];
      const margin = 8;   // pixels of the picture
      const scale = Math.min(stage.clientWidth / (w + 2 * margin), stage.clientHeight / (h + 2 * margin), 32);
      this.free = { scale: scale >= 2 ? Math.floor(scale) : scale, x: x + w / 2, y: y + h / 2 };
      this.bound();
    }

    zoom_to_change() {
      if (this.changed) this.zoom_to(this.changed.x, this.changed.y, this.changed.w, this.changed.h);
    }

    pan(dx, dy) {
      const view = this.view();
      this.free = { scale: view.scale, x: view.x - dx / view.scale, y: view.y - dy / view.scale };
      this.bound();
    }

    listen(stage) {
      const at = (event) => {
        const box = stage.getBoundingClientRect(), view = this.view();
        return [(event.clientX - box.left - view.left(stage)) / view.scale, (event.clientY - box.top - view.top(stage)) / view.scale];
      };
      stage.onpointerdown = (event) => {
        if (event.button > 0) return;
        // A finger scrolls the page until the picture is zoomed.
        if (event.pointerType === "touch" && !this.free && this.pointers.size === 0) return;
        stage.setPointerCapture(event.pointerId);
        this.pointers.set(event.pointerId, event);
        stage.classList.add("dragged");
      };
      stage.onpointermove = (event) => {
        const last = this.pointers.get(event.pointerId);
        if (last) {
          const others = [...this.pointers.values()].filter((other) => other.pointerId !== event.pointerId);
          this.pointers.set(event.pointerId, event);
          if (others.length === 0) this.pan(event.clientX - last.clientX, event.clientY - last.clientY);
          else {
            const distance = (from) => Math.hypot(from.clientX - others[0].clientX, from.clientY - others[0].clientY) || 1;
            this.zoom_by(distance(event) / distance(last), ...at(event));
          }
        }
        this.read_out(...at(event));
      };
      stage.onpointerup = stage.onpointercancel = (event) => {
        this.pointers.delete(event.pointerId);
        stage.classList.remove("dragged");
      };
      stage.onpointerleave = () => (this.readout.textContent = "");
      stage.addEventListener("wheel", (event) => {
        if (!event.ctrlKey && !event.metaKey) return;
        event.preventDefault();
        this.zoom_by(2 ** (-event.deltaY / 200), ...at(event));
      }, { passive: false });
      stage.ondblclick = (event) => (this.free ? this.fit() : this.zoom_by(4, ...at(event)));
      stage.onkeydown = (event) => {
        if (event.target !== stage || event.ctrlKey || event.metaKey || event.altKey) return;
        const step = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] }[event.key];
        if (!step) return;
        event.preventDefault();
        this.pan(...step);
      };
    }

    /** The colors of a pixel under the pointer. */
    async read_out(x, y) {
      const column = Math.floor(x), row = Math.floor(y);
      if (column < 0 || row < 0 || column >= this.width || row >= this.height) {
        this.readout.textContent = "";
        return;
      }
      const pair = await this.pixels();
      const parts = [`x ${column}, y ${row}`];
      if (pair) {
        const colors = pair.map((data) => [...data.data.slice(4 * (row * data.width + column), 4 * (row * data.width + column) + 4)]);
        for (const [index, color] of colors.entries()) {
          const swatch = element("span", { className: "swatch" });
          swatch.style.background = `rgb(${color.slice(0, 3).join(" ")} / ${color[3] / 255})`;
          parts.push(swatch, `${index ? "image" : "reference"} ${color.slice(0, color[3] === 255 ? 3 : 4).join(" ")}`);
        }
        parts.push(`  difference ${Math.max(...colors[0].map((value, i) => Math.abs(value - colors[1][i])))}`);
      }
      this.readout.replaceChildren(...parts);
    }

    close() {
      this.stop();
      this.resized.disconnect();
      this.root.remove();
      this.pictures.classList.add("pictures");
    }
  }

  function draw_difference(canvas, [a, b], gain) {
    const context = canvas.getContext("2d");
    const result = context.createImageData(canvas.width, canvas.height);
    const to = result.data;
    for (let i = 0; i < to.length; i += 4) {
      const alpha = Math.abs(a.data[i + 3] - b.data[i + 3]);
      for (let c = 0; c < 3; ++c) to[i + c] = Math.max(Math.abs(a.data[i + c] - b.data[i + c]), alpha) * gain;
      to[i + 3] = 255;
    }
    context.putImageData(result, 0, 0);
  }

  // The list, its filter, and the image that is shown.
  const items = [...document.querySelectorAll(".list li")];
  if (!items.length) return;
  const links = items.map((item) => item.querySelector("a"));
  const articles = links.map((link) => document.querySelector(link.getAttribute("href")));
  let current = -1, viewer = null;

  /** Brings an item into the view of the list, without moving the page. */
  function show_item(item) {
    const list = item.closest(".list"), strip = item.closest("ol");
    const inside = item.getBoundingClientRect();
    for (const [box, start, end, place] of [[list, "top", "bottom", "scrollTop"], [strip, "left", "right", "scrollLeft"]]) {
      const outside = box.getBoundingClientRect();
      box[place] += Math.min(0, inside[start] - outside[start]) + Math.max(0, inside[end] - outside[end]);
    }
  }

  // The first image has no address of its own: while a page loads, the browser would scroll to it.
  function select(index, scroll, address = true) {
    if (index === current || !articles[index]) return;
    viewer?.close();
    viewer = null;
    current = index;
    for (const [i, article] of articles.entries()) {
      article.hidden = i !== index;
      if (i === index) links[i].setAttribute("aria-current", "true");
      else links[i].removeAttribute("aria-current");
    }
    const pictures = articles[index].querySelector(".pictures");
    if (pictures) viewer = new Viewer(pictures);
    if (address) history.replaceState(null, "", links[index].getAttribute("href"));
    show_item(items[index]);
    if (scroll) articles[index].scrollIntoView({ block: "nearest" });
  }

  const visible = () => items.flatMap((item, i) => (item.hidden ? [] : [i]));

  function step(by) {
    const shown = visible();
    const next = shown[clamp(shown.indexOf(current) + by, 0, shown.length - 1)];
    if (next !== undefined) select(next, false);
  }

  function filter(verdict) {
    chosen.verdict = verdict;
    for (const item of items) item.hidden = Boolean(verdict) && item.dataset.verdict !== verdict;
    for (const chip of chips) chip.setAttribute("aria-pressed", String(chip.dataset.verdict === verdict));
    const shown = visible();
    if (shown.length && !shown.includes(current)) select(shown[0], false);
  }

  const verdicts = [...new Set(items.map((item) => item.dataset.verdict))];
  const chips = ["", ...verdicts].map((verdict) => {
    const count = verdict ? items.filter((item) => item.dataset.verdict === verdict).length : items.length;
    const chip = button(`${verdict || "all"} ${count}`, "", () => filter(verdict));
    chip.className = "chip";
    chip.dataset.verdict = verdict;
    return chip;
  });
  if (verdicts.length > 1) {
    document.querySelector(".list").prepend(element("div", { className: "filters", role: "group", "aria-label": "Verdicts in the list" }, ...chips));
  }

  for (const [i, link] of links.entries()) {
    link.addEventListener("click", (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return;
      event.preventDefault();
      select(i, true);
    });
  }
  for (const place of document.querySelectorAll("td.place")) {
    const text = place.textContent;
    place.replaceChildren(button(text, `Zoom to ${text}`, () => viewer?.zoom_to(Number(place.dataset.x), Number(place.dataset.y), 8, 8)));
  }

  const keys = {
    j: () => step(1), k: () => step(-1), f: () => viewer?.fit(), c: () => viewer?.zoom_to_change(),
    "+": () => viewer?.zoom_by(2), "=": () => viewer?.zoom_by(2), "-": () => viewer?.zoom_by(0.5),
  };
  modes.forEach((mode, i) => {
    keys[i + 1] = () => {
      if (viewer?.modes().includes(mode)) viewer.set_mode(mode.key);
    };
  });
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest("select, input, textarea")) return;
    if (event.key === " ") {
      if (viewer?.mode() !== "blink" || event.target.closest("button, a, summary")) return;
      event.preventDefault();
      viewer.stop();
      viewer.swap();
      return;
    }
    keys[event.key]?.();
  });
  addEventListener("hashchange", () => {
    const index = links.findIndex((link) => link.getAttribute("href") === location.hash);
    if (index >= 0) select(index, true);
  });

  const help = [["j", "k"], "next and previous image", ["1", "6"], "view", ["+", "−"], "zoom", ["c"], "changed region", ["f"], "fit"];
  const about = document.querySelector(".about dl");
  const described = element("dd");
  for (let i = 0; i < help.length; i += 2) {
    if (i) described.append(", ");
    described.append(element("kbd", { textContent: help[i][0] }));
    if (help[i][1]) described.append(help[i][0] === "1" ? " to " : " ", element("kbd", { textContent: help[i][1] }));
    described.append(` ${help[i + 1]}`);
  }
  about?.append(element("div", {}, element("dt", { textContent: "Keys" }), described));

  const linked = links.findIndex((link) => link.getAttribute("href") === location.hash);
  select(Math.max(linked, 0), false, false);
})();
