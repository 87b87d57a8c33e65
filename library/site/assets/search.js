// The search of the first page: words by BM25, with the arithmetic of library/index/search.hpp, ranges of levels, and
// the order by a level.
"use strict";
(() => {
  const form = document.getElementById("search");
  if (!form) return;
  const words = document.getElementById("words"), kind = document.getElementById("kind");
  const order = document.getElementById("order"), reverse = document.getElementById("reverse");
  const told = document.getElementById("told"), results = document.getElementById("results");
  const browse = document.getElementById("browse");
  const shownAtOnce = 48;
  let shown = shownAtOnce, latest = 0;
  form.hidden = false;

  /** The words of a text, as `words_of` of library/index/words.hpp has them. */
  function wordsOf(text) {
    const folded = text.normalize("NFKD").toUpperCase().toLowerCase().replace(/ς/g, "σ").normalize("NFKD")
      .replace(/[\p{M}\p{Default_Ignorable_Code_Point}]/gu, "");
    const found = folded.match(/[\u3040-\u30ff\u3400-\u9fff\uf900-\ufaff\u{20000}-\u{3ffff}]|[\p{L}\p{N}]+/gu) || [];
    const alone = /[\u3040-\u30ff\u3400-\u9fff\uf900-\ufaff\u{20000}-\u{3ffff}]/u;
    const all = [];
    for (const run of found) {
      let word = [];
      const end = () => { if (word.length) all.push(word.slice(0, 32).join("")); word = []; };
      for (const character of run) {
        if (alone.test(character)) { end(); all.push(character); } else word.push(character);
      }
      end();
    }
    return [...new Set(all)].slice(0, 32);
  }

  function log2InSteps(x) {
    let whole = 0, part = 0, digit = 1;
    while (x >= 2) { x /= 2; whole += 1; }
    for (let i = 0; i < 16; ++i) {
      digit /= 2;
      x *= x;
      if (x >= 2) { x /= 2; part += digit; }
    }
    return whole + part;
  }

  /** The order of UTF-8, in which the words are stored. */
  function before(a, b) {
    const first = Array.from(a), second = Array.from(b);
    for (let i = 0; i < Math.min(first.length, second.length); ++i)
      if (first[i] !== second[i]) return first[i].codePointAt(0) < second[i].codePointAt(0);
    return first.length < second.length;
  }

  /** The materials that have a word which begins so: number -> weight. */
  async function hitsOf(table, word) {
    const hits = new Map();
    const begins = table.begins;
    let at = 0;
    while (at + 1 < begins.length && !before(word, begins[at + 1])) ++at;
    for (; at < begins.length; ++at) {
      if (before(word, begins[at]) && !begins[at].startsWith(word)) break;
      for (const [found, steps, weights] of await wale.data("words-p" + at)) {
        if (!found.startsWith(word)) continue;
        let material = 0;
        steps.forEach((step, i) => {
          material += step;
          hits.set(material, (hits.get(material) || 0) + (found === word ? 2 * weights[i] : weights[i]));
        });
      }
    }
    return hits;
  }

  /** Number -> score, of the materials with all words, or else with some. */
  async function scored(table, columns, sought) {
    const sums = new Map();
    for (const word of sought) {
      const hits = await hitsOf(table, word);
      const idf = log2InSteps((2 * table.materials + 2) / (2 * hits.size + 1));
      const mean = table.length / table.materials;
      for (const material of [...hits.keys()].sort((a, b) => a - b)) {
        const weight = hits.get(material);
        const norm = 0.25 + 0.75 * (columns.lengths[material] / mean);
        const sum = sums.get(material) || {score: 0, words: 0};
        sum.score += idf * (weight * 2.2) / (weight + 1.2 * norm);
        sum.words += 1;
        sums.set(material, sum);
      }
    }
    const all = [...sums].filter(([, sum]) => sum.words === sought.length);
    return new Map((all.length ? all : [...sums]).map(([material, sum]) => [material, sum.score]));
  }

  function levelsOf(columns, percept) {
    const levels = new Map(), [materials, values] = columns.levels[percept] || [[], []];
    materials.forEach((material, i) => levels.set(material, values[i]));
    return levels;
  }

  /** The numbers of the materials that are asked for, the best first. */
  async function found(ask) {
    const table = await wale.data("search"), columns = await wale.data("levels");
    const scores = ask.words.length ? await scored(table, columns, ask.words) : null;
    let numbers = scores ? [...scores.keys()] : [...Array(table.materials).keys()];
    if (ask.kind)
      numbers = numbers.filter(i => {
        const own = columns.kinds[columns.kind[i]];
        return own === ask.kind || own.startsWith(ask.kind + ".");
      });
    for (const {percept, least, most} of ask.ranges) {
      const levels = levelsOf(columns, percept);
      numbers = numbers.filter(i => levels.has(i) && levels.get(i) >= least && levels.get(i) <= most);
    }
    if (ask.order) {
      const levels = levelsOf(columns, ask.order), sign = ask.reverse ? 1 : -1;
      numbers = numbers.filter(i => levels.has(i)).sort((a, b) => sign * (levels.get(a) - levels.get(b)) || a - b);
    } else if (scores) {
      numbers.sort((a, b) => scores.get(b) - scores.get(a) || a - b);
    }
    return {numbers, table};
  }

  function asked() {
    const ranges = new Map();
    for (const input of form.querySelectorAll("[data-least], [data-most]")) {
      const percept = input.dataset.least ?? input.dataset.most;
      const value = parseFloat(input.value);
      if (!Number.isFinite(value)) continue;
      const range = ranges.get(percept) || {percept, least: -Infinity, most: Infinity};
      if (input.dataset.least !== undefined) range.least = value; else range.most = value;
      ranges.set(percept, range);
    }
    return {words: wordsOf(words.value), text: words.value.trim(), kind: kind.value, order: order.value,
            reverse: reverse.checked, ranges: [...ranges.values()]};
  }

  async function cardOf(table, number) {
    const cards = await wale.data("cards-p" + Math.floor(number / table.cards));
    const [page, title, of, picture, extent, levels] = cards[number % table.cards];
    const made = wale.element;
    return made("li", {class: "card"},
      made("a", {href: "material/" + page + ".html"},
        made("img", {src: picture, width: 160, height: 160, loading: "lazy", alt: ""}), made("strong", {}, title)),
      made("small", {}, of), made("small", {}, extent),
      made("small", {class: "levels"},
        ...levels.slice(0, 3).map(([percept, level]) => made("span", {}, percept + " " + level.toFixed(2)))));
  }

  async function show() {
    const turn = ++latest, ask = asked();
    const any = ask.text || ask.kind || ask.order || ask.ranges.length;
    browse.hidden = Boolean(any);
    results.hidden = !any;
    if (!any) { told.textContent = ""; results.replaceChildren(); return; }
    try {
      const begun = performance.now();
      const {numbers, table} = ask.text && !ask.words.length ? {numbers: [], table: null} : await found(ask);
      if (turn !== latest) return;
      form.dataset.milliseconds = (performance.now() - begun).toFixed(2);
      const cards = await Promise.all(numbers.slice(0, shown).map(number => cardOf(table, number)));
      if (turn !== latest) return;
      told.textContent = numbers.length === 0 ? "No material is found." :
        numbers.length + (numbers.length === 1 ? " material" : " materials");
      const list = wale.element("ul", {class: "cards"}, ...cards);
      results.replaceChildren(list);
      if (numbers.length > shown) {
        const more = wale.element("button", {type: "button"}, "Show more");
        more.addEventListener("click", async () => {
          const begin = shown;
          shown += shownAtOnce;
          await show();
          results.querySelectorAll(".card a")[begin]?.focus();
        });
        results.append(more);
      }
    } catch (error) {
      told.textContent = "The search cannot load its data: " + error.message;
    }
  }

  function again() { shown = shownAtOnce; show(); }
  form.addEventListener("input", again);
  form.addEventListener("change", again);
  form.addEventListener("submit", event => event.preventDefault());
  form.addEventListener("keydown", event => { if (event.key === "Enter" && event.target === words) event.preventDefault(); });
  // The data come before the first letter is typed.
  words.addEventListener("focus", () => { wale.data("levels").catch(() => {}); }, {once: true});
  if (asked().text || kind.value || order.value) show();  // a browser fills fields in again on the way back
})();
