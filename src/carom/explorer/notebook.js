// The plane of kicks and the motion after one of them below a cell of a notebook, drawn by the parts of the page.
const page = PAGE;

// The parts find the document and the window that are given, so that they stay inside their widget.
const parts = (document, window) => {
PARTS
  carom.plots = null;
  // What else the page has is not here: it is told, and does nothing.
  carom.controls = carom.panels = new Proxy({}, { get: () => () => {} });
  return carom;
};

// An object that has the own properties given, and otherwise those of another object.
const over = (whole, own) => new Proxy({}, {
  get: (_, name) => {
    if (name in own) return own[name];
    const found = whole[name];
    return typeof found === "function" ? found.bind(whole) : found;
  },
  set: (_, name, value) => { own[name] = value; return true; },
});

const decoded = (value, buffers) => {
  if (Array.isArray(value)) return value.map((entry) => decoded(entry, buffers));
  if (value === null || typeof value !== "object") return value;
  if ("buffer" in value) {
    const { buffer, byteOffset, byteLength } = buffers[value.buffer];
    const bytes = buffer.slice(byteOffset, byteOffset + byteLength);
    return value.type === "float32" ? new Float32Array(bytes) : new Uint8Array(bytes);
  }
  return Object.fromEntries(Object.entries(value).map(([name, entry]) => [name, decoded(entry, buffers)]));
};

const render = ({ model, el }) => {
  const host = document.createElement("div"), root = host.attachShadow({ mode: "open" });
  const ended = new AbortController(), absent = {};
  root.innerHTML = `<style>${page.style}</style><div class="stage">${page.figures}</div>`;
  el.append(host);
  const carom = parts(
    over(document, {
      documentElement: host,
      getElementById: (id) => root.getElementById(id) || (absent[id] ||= document.createElement("div")),
      querySelectorAll: (selector) => root.querySelectorAll(selector),
    }),
    over(window, {
      carom_looks: page.looks,
      addEventListener: (name, act) => window.addEventListener(name, act, { signal: ended.signal }),
    }),
  );
  carom.requests = new Proxy({}, { set: (_, name, value) => { model.send({ name, value }); return true; } });

  const shows = { basin: carom.basin.show, motion: carom.motion.show };
  const take = (content, buffers) => {
    if (content.name in shows) shows[content.name](decoded(content.value, buffers));
  };
  model.on("msg:custom", take);

  // Light or dark as the notebook is, which need not be as the system is: its text tells.
  const shade = () => {
    if (!el.isConnected) return;
    const [red, green, blue] = getComputedStyle(el).color.match(/[\d.]+/g).map(Number);
    const now = 0.2126 * red + 0.7152 * green + 0.0722 * blue > 127 ? "dark" : "light";
    if (host.className !== now) { host.className = now; carom.redraw(); }
  };
  const restyled = new MutationObserver(shade);
  for (const whole of [document.documentElement, document.body]) restyled.observe(whole, { attributes: true });
  // A notebook puts it on the page after this, which gives it a size.
  const resized = new ResizeObserver(carom.throttled(60, () => { shade(); carom.redraw(); }));
  resized.observe(host);

  const words = root.getElementById("motion-words");
  if (words) words.textContent = "Loading the kernels …";
  carom.requests.machine = { number: 1, settings: {}, held: false, along: "" };
  return () => {
    model.off("msg:custom", take);
    ended.abort();
    restyled.disconnect();
    resized.disconnect();
  };
};

export default { render };
