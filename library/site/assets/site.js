// What the scripts of all pages share. Data come as scripts, `wale.take(name, data)`, since a page that was opened from a
// disk may load no other files.
"use strict";
const wale = (() => {
  const taken = new Map();    // name -> data
  const waiting = new Map();  // name -> {promise, resolve}
  // The way to the top of the site, from the address of this script.
  const root = document.currentScript.src.replace(/site\.js$/, "");

  function take(name, data) {
    taken.set(name, data);
    if (waiting.has(name)) waiting.get(name).resolve(data);
  }
  /** Loads `data/NAME.js` once; the promise gives its data. */
  function data(name, path = "data/" + name + ".js") {
    if (taken.has(name)) return Promise.resolve(taken.get(name));
    if (!waiting.has(name)) {
      let resolve, reject;
      const promise = new Promise((yes, no) => { resolve = yes; reject = no; });
      waiting.set(name, {promise, resolve});
      const script = document.createElement("script");
      script.src = root + path;
      script.onerror = () => { waiting.delete(name); reject(new Error("cannot load " + path)); };
      document.head.append(script);
    }
    return waiting.get(name).promise;
  }
  /** An element with attributes and children; texts are texts, never tags. */
  function element(tag, attributes = {}, ...children) {
    const made = document.createElement(tag);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
  }
  return {take, data, element, root};
})();
