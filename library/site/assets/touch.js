// The surface of a material under the pointer: light that follows it, a light finger that the force pulls, and the sound of
// that force. All of it is looked up in tables that the finished program filled (library/site/figures.cpp).
"use strict";
(() => {
  const panel = document.querySelector(".touch[data-touch]");
  if (!panel) return;
  const stage = panel.closest("figure").querySelector(".stage");
  const output = panel.querySelector("output");
  const button = act => panel.querySelector("[data-act=" + act + "]");
  const canvas = wale.element("canvas", {tabindex: 0, role: "application", "aria-label":
    "The surface. Arrow keys move a light finger.", "aria-describedby": "touch-hint"});
  stage.append(canvas);
  panel.hidden = false;

  let tables = null, loading = false;
  let target = {x: 0, y: 0};         // m from the picture's middle, y upwards: where the pointer is
  let finger = {x: 0, y: 0}, speed = {x: 0, y: 0};
  let touched = false, frame = 0, last = 0, told = -Infinity;
  let pulls = !matchMedia("(prefers-reduced-motion: reduce)").matches;
  button("pull").setAttribute("aria-pressed", pulls);
  let sound = null;

  /** The bytes of a picture in a `data:` address: red, green, blue and 255 for each pixel. */
  async function bytesOf(address) {
    const image = new Image();
    image.src = address;
    await image.decode();
    const copy = document.createElement("canvas");
    copy.width = image.width;
    copy.height = image.height;
    const context = copy.getContext("2d", {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    return {side: image.width, bytes: context.getImageData(0, 0, image.width, image.height).data};
  }

  async function load() {
    if (tables || loading) return;
    loading = true;
    try {
      const touch = await wale.data("touch", panel.dataset.touch.replace(/^(\.\.\/)+/, ""));
      const force = await bytesOf(touch.force.table);
      const slopes = touch.slopes ? await bytesOf(touch.slopes) : null;
      const colours = touch.colours ? await bytesOf(touch.colours) : null;
      tables = {touch, force, slopes, colours, shaded: slopes ? new ImageData(slopes.side, slopes.side) : null};
      begin();
    } catch (error) {
      output.textContent = "The table of the force cannot be loaded.";
    }
  }

  /** The force at a place, N, between the places of the table. */
  function forceAt(place) {
    const {side, bytes} = tables.force, newton = tables.touch.force.newton;
    const column = (place.x / tables.touch.side + 0.5) * side - 0.5, row = (0.5 - place.y / tables.touch.side) * side - 0.5;
    const c = Math.min(side - 2, Math.max(0, Math.floor(column))), r = Math.min(side - 2, Math.max(0, Math.floor(row)));
    const u = Math.min(1, Math.max(0, column - c)), v = Math.min(1, Math.max(0, row - r));
    const at = (i, j, part) => (bytes[4 * ((r + j) * side + c + i) + part] - 128) / 127;
    const mean = part => (at(0, 0, part) * (1 - u) + at(1, 0, part) * u) * (1 - v) +
                         (at(0, 1, part) * (1 - u) + at(1, 1, part) * u) * v;
    return {x: newton * mean(0), y: newton * mean(1)};
  }

  /** How much the material resists a speed, N s/m. */
  function resistance(fast) {
    const table = tables.touch.speed;
    if (!table || !(fast > 1e-4)) return 0;
    const middle = (table.newton.length - 1) / 2;
    const at = middle + Math.min(1, fast / table.fastest) * middle, i = Math.min(table.newton.length - 2, Math.floor(at));
    const newton = table.newton[i] + (at - i) * (table.newton[i + 1] - table.newton[i]);
    return Math.max(0, -newton / fast);
  }

  /** A finger without mass on a soft spring to the pointer: the largest force moves it by a sixteenth of the picture. */
  function move(seconds) {
    const {side, force} = tables.touch;
    const limit = side / 2, stiffness = Math.max(force.newton, 0.05) / (side / 16), damping = 0.03 * stiffness;
    const steps = Math.max(1, Math.min(60, Math.round(seconds * 1000)));
    const path = [];
    for (let i = 0; i < steps; ++i) {
      const pull = pulls ? forceAt(finger) : {x: 0, y: 0};
      const resists = damping + (pulls ? resistance(Math.hypot(speed.x, speed.y)) : 0);
      speed = {x: (stiffness * (target.x - finger.x) + pull.x) / resists, y: (stiffness * (target.y - finger.y) + pull.y) / resists};
      finger = {x: Math.min(limit, Math.max(-limit, finger.x + 0.001 * speed.x)),
                y: Math.min(limit, Math.max(-limit, finger.y + 0.001 * speed.y))};
      path.push(finger);
    }
    return path;
  }

  // Plaster in the light, as compiler/preview/relief.cpp draws it.
  const plaster = [221, 209, 190], umbra = [57, 48, 46], glint = [255, 253, 246];
  function light() {
    const {slopes, colours, shaded, touch} = tables;
    let across = touched ? Math.max(-1, Math.min(1, 2 * target.x / touch.side)) : -0.76;
    let up = touched ? Math.max(-1, Math.min(1, 2 * target.y / touch.side)) : 0.76;
    // Light from straight above shows no relief.
    const low = 0.5, aside = Math.hypot(across, up);
    if (aside < low) { across = aside > 0 ? across * low / aside : -low; up = aside > 0 ? up * low / aside : 0; }
    const length = Math.hypot(0.68 * across, 0.68 * up, 0.68);
    const lx = 0.68 * across / length, ly = 0.68 * up / length, lz = 0.68 / length;
    const pixels = shaded.data, bytes = slopes.bytes, scale = touch.steepest / 127;
    for (let i = 0; i < pixels.length; i += 4) {
      const sx = (bytes[i] - 128) * scale, sy = (bytes[i + 1] - 128) * scale;
      const tone = (lz - sx * lx - sy * ly) / Math.sqrt(sx * sx + sy * sy + 1) - lz;
      const shade = Math.min(0.92, 0.1 * (1 - bytes[i + 2] / 255) + (tone < 0 ? -0.95 * tone : 0));
      const shine = Math.min(0.95, Math.max(0, 2.6 * tone));
      for (let part = 0; part < 3; ++part) {
        const bright = plaster[part] + (glint[part] - plaster[part]) * shine;
        const lamp = bright + (umbra[part] - bright) * shade;
        pixels[i + part] = colours ? Math.min(255, colours.bytes[i + part] * lamp / plaster[part]) : lamp;
      }
      pixels[i + 3] = 255;
    }
  }

  const flat = document.createElement("canvas");
  function draw() {
    const side = Math.max(1, Math.round(stage.clientWidth * Math.min(2, devicePixelRatio)));
    if (canvas.width !== side) { canvas.width = side; canvas.height = side; }
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, side, side);
    if (tables.slopes) {
      light();
      flat.width = flat.height = tables.slopes.side;
      flat.getContext("2d").putImageData(tables.shaded, 0, 0);
      context.imageSmoothingQuality = "high";
      context.drawImage(flat, 0, 0, side, side);
    }
    if (!touched) return;
    const on = place => [(place.x / tables.touch.side + 0.5) * side, (0.5 - place.y / tables.touch.side) * side];
    const [px, py] = on(target), [fx, fy] = on(finger), unit = side / 100;
    context.lineWidth = 0.6 * unit;
    context.strokeStyle = "#ffffffb0";
    context.beginPath();
    context.moveTo(px, py);
    context.lineTo(fx, fy);
    context.stroke();
    for (const [colour, width] of [["#ffffff", 2.2], ["#b3301e", 1.1]]) {
      context.strokeStyle = colour;
      context.lineWidth = width * unit;
      context.beginPath();
      context.arc(fx, fy, 2.6 * unit, 0, 7);
      context.stroke();
    }
    context.fillStyle = "#221f1d";
    context.beginPath();
    context.arc(px, py, 0.8 * unit, 0, 7);
    context.fill();
  }

  function tell(now, rests) {
    if (!rests && now - told < 120) return;
    told = now;
    const force = forceAt(finger), newton = Math.hypot(force.x, force.y);
    const mm = value => (1000 * value).toFixed(1).replace("-", "\u2212");
    output.textContent = "at " + mm(finger.x) + " mm, " + mm(finger.y) + " mm: " + newton.toFixed(2) + " N";
  }

  function run(now) {
    const seconds = Math.min(0.06, Math.max(0.001, (now - last) / 1000));
    last = now;
    const before = finger;
    const path = move(seconds);
    if (sound) sing(path, seconds);
    draw();
    const still = Math.hypot(finger.x - before.x, finger.y - before.y) < 1e-6 * tables.touch.side;
    tell(now, still);
    frame = still && !sound ? 0 : requestAnimationFrame(run);
  }
  function wake() {
    if (!tables) { load(); return; }
    if (!frame) { last = performance.now(); frame = requestAnimationFrame(run); }
  }
  function begin() { finger = {...target}; draw(); wake(); }

  /** The force along the way of the finger since the last frame, as sound without its constant part. */
  function sing(path, seconds) {
    const {context, gain} = sound, count = Math.max(16, Math.round(seconds * context.sampleRate));
    const buffer = context.createBuffer(1, count, context.sampleRate), samples = buffer.getChannelData(0);
    const scale = 1 / Math.max(tables.touch.force.newton, 1e-9), [wx, wy] = tables.touch.way;
    for (let i = 0; i < count; ++i) {
      const at = (i + 1) / count * path.length, k = Math.min(path.length - 1, Math.floor(at)), part = Math.min(1, at - k);
      const from = k === 0 ? sound.place : path[k - 1], to = path[k];
      const force = forceAt({x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y)});
      const value = tables.touch.force.newton > 0 ? scale * (force.x * wx + force.y * wy) : 0;
      sound.out = 0.997 * (sound.out + value - sound.value);
      sound.value = value;
      samples[i] = sound.out;
    }
    sound.place = path[path.length - 1];
    const source = context.createBufferSource();
    source.buffer = buffer;
    source.connect(gain);
    sound.next = Math.max(sound.next, context.currentTime + 0.03);
    if (sound.next > context.currentTime + 0.25) return;  // frames come faster than sound is played
    source.start(sound.next);
    sound.next += count / context.sampleRate;
  }

  function place(event) {
    const box = stage.getBoundingClientRect(), side = tables ? tables.touch.side : 1;
    target = {x: ((event.clientX - box.left) / box.width - 0.5) * side, y: (0.5 - (event.clientY - box.top) / box.height) * side};
    touched = true;
    wake();
  }
  canvas.addEventListener("pointerenter", load);
  canvas.addEventListener("focus", load);
  canvas.addEventListener("pointermove", event => { if (tables) place(event); else load(); });
  canvas.addEventListener("pointerdown", event => { if (tables) place(event); else load(); });
  canvas.addEventListener("keydown", event => {
    const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (!step || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (!tables) { load(); return; }
    const side = tables.touch.side, far = side / (event.shiftKey ? 10 : 80);
    target = {x: Math.max(-side / 2, Math.min(side / 2, target.x + far * step[0])),
              y: Math.max(-side / 2, Math.min(side / 2, target.y + far * step[1]))};
    touched = true;
    output.setAttribute("aria-live", "polite");
    wake();
  });
  button("pull").addEventListener("click", () => {
    pulls = !pulls;
    button("pull").setAttribute("aria-pressed", pulls);
    wake();
  });
  button("sound").addEventListener("click", () => {
    if (sound) {
      sound.context.close();
      sound = null;
    } else {
      const context = new AudioContext(), gain = context.createGain();
      gain.gain.value = 0.3;
      gain.connect(context.destination);
      sound = {context, gain, next: 0, value: 0, out: 0, place: finger};
    }
    button("sound").setAttribute("aria-pressed", Boolean(sound));
    wake();
  });
})();
