// The plane of materials: the dot under the pointer, or the one chosen by the arrow keys, is named, and leads to its page.
"use strict";
(() => {
  const plane = document.querySelector(".plane[data-plane]"), line = document.getElementById("dot");
  if (!plane) return;
  const canvas = wale.element("canvas", {tabindex: 0, role: "application", "aria-label":
    "Materials on a plane. Arrow keys go from dot to dot, Enter opens one.", "aria-describedby": "dot"});
  plane.append(canvas);
  let dots = null, chosen = -1, latest = 0;

  async function cardOf(dot) {
    const table = await wale.data("search"), number = dots.at[dot];
    return (await wale.data("cards-p" + Math.floor(number / table.cards)))[number % table.cards];
  }
  async function choose(dot) {
    if (dot === chosen || dot < 0) return;
    chosen = dot;
    draw();
    const turn = ++latest, card = await cardOf(dot);
    if (turn !== latest) return;
    line.replaceChildren(wale.element("a", {href: "material/" + card[0] + ".html"}, card[1]),
      (card[2] ? " · " + card[2] : "") + card[5].slice(0, 4).map(level => " · " + level[0] + " " + level[1].toFixed(2)).join(""));
  }
  function draw() {
    const width = canvas.width = Math.round(plane.clientWidth * Math.min(2, devicePixelRatio));
    const height = canvas.height = Math.round(plane.clientHeight * Math.min(2, devicePixelRatio));
    if (chosen < 0) return;
    const context = canvas.getContext("2d");
    context.beginPath();
    context.arc(dots.x[chosen] / 1e4 * width, dots.y[chosen] / 1e4 * height, 9 * Math.min(2, devicePixelRatio), 0, 7);
    context.lineWidth = 3 * Math.min(2, devicePixelRatio);
    context.strokeStyle = dots.shades[dots.kind[chosen]];
    context.stroke();
  }
  /** The nearest dot to a place, 0 .. 1 each way; with a direction, the nearest that lies there. */
  function nearest(x, y, way) {
    const aspect = plane.clientWidth / plane.clientHeight;
    let best = -1, least = Infinity;
    for (let i = 0; i < dots.x.length; ++i) {
      const dx = (dots.x[i] / 1e4 - x) * aspect, dy = dots.y[i] / 1e4 - y;
      if (way && (i === chosen || dx * way[0] + dy * way[1] <= Math.abs(dx * way[1] - dy * way[0]))) continue;
      const far = dx * dx + dy * dy;
      if (far < least) { least = far; best = i; }
    }
    return best;
  }
  let loading = null;
  function load() {
    loading ||= wale.data("space").then(data => { dots = data; draw(); }, () => { line.textContent = "The dots cannot be loaded."; });
    return loading;
  }
  canvas.addEventListener("focus", async () => { await load(); if (dots && chosen < 0) choose(nearest(0.5, 0.5)); });
  canvas.addEventListener("pointermove", async event => {
    await load();
    const box = plane.getBoundingClientRect();
    if (dots) choose(nearest((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height));
  });
  canvas.addEventListener("click", () => { const link = line.querySelector("a"); if (link) link.click(); });
  canvas.addEventListener("keydown", event => {
    const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    if (event.key === "Enter") line.querySelector("a")?.click();
    if (!way || !dots || chosen < 0 || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    choose(nearest(dots.x[chosen] / 1e4, dots.y[chosen] / 1e4, way));
  });
  addEventListener("resize", () => { if (dots) draw(); });
})();
