// Where kicks lead and the motions after two of them below a cell of a notebook, drawn by the pictures of the page.
const page = PAGE;

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

const legendOf = (message) => message.endings.map((one) => {
  const item = document.createElement("li"), swatch = document.createElement("canvas");
  swatch.width = swatch.height = 24;
  const pen = swatch.getContext("2d");
  pen.fillStyle = pen.createPattern(tile(one.colour, one.hatch).canvas, "repeat");
  pen.fillRect(0, 0, 24, 24);
  item.append(swatch, `${one.words} `, `${short(100 * one.share, 3)} %`);
  return item;
});

const render = ({ model, el }) => {
  const host = document.createElement("div"), root = host.attachShadow({ mode: "open" }), at = (id) => root.getElementById(id);
  root.innerHTML = page.body;
  el.append(host);
  const { slots, planes } = page;
  let asked = 0, active = 0, chosen = null;

  // A flight for each kick and plane, with what is said of it below.
  const flights = slots.flatMap((name, slot) => Array.from({ length: planes }, (_, plane) => {
    const place = document.createElement("div"), canvas = document.createElement("canvas"), words = document.createElement("p");
    canvas.id = `${name}-${plane}`;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `Path of the rotor inside touchdown bearing ${plane + 1} after kick ${slot + 1}`);
    words.className = "soft";
    words.id = `${name}-${plane}-words`;
    place.append(canvas, words);
    at("flights").append(place);
    const made = flight(canvas, { looks: page.looks });
    made.frame = page.frame;
    return Object.assign(made, { words, slot, plane });
  }));
  const marked = () => chosen || slots.map((_, slot) => flights[slot * planes].message && flights[slot * planes].message.kick).filter(Boolean);
  // What comes back is flown as 1, what is lost as 2.
  const basin = basinPicture(at("basin"), { onPoint: (kick, clicked, slot = null) => {
    const ending = basin.endingOf(kick), both = marked();
    if (both.length < slots.length) return;
    active = slots.length === 1 ? 0 : slot === null ? (ending && ending.back ? 0 : 1) : slot;
    chosen = both.map((one, place) => (place === active ? kick : one));
    basin.mark(chosen, active);
    asked += 1;
    model.send({ name: "kick", value: { number: asked, slot: active, ...kick, chosen: clicked } });
  } });

  const shows = {
    basin: (message) => {
      if (message.refused) { at("sentence").textContent = message.refused; return; }
      for (const one of flights) one.rest = message.rest_position && { position: message.rest_position, colour: message.legend_rest };
      basin.kicks = marked();
      basin.show(message);
      at("sentence").textContent = message.sentence;
      at("legend").replaceChildren(...legendOf(message));
    },
  };
  shows.levitating = (message) => {
    at("levitation").hidden = false;
    at("levitation").textContent = message.refused || `${message.lead} ${message.more}`;
  };
  slots.forEach((name, slot) => {
    shows[name] = (message) => {
      for (const one of flights.filter((each) => each.slot === slot)) {
        const part = message.planes ? message.planes[one.plane] : {};
        one.show({ ...message, ...part });
        const more = part.words ? `Touchdown bearing ${one.plane + 1}: ${part.words}. ` : "";
        one.words.textContent = message.refused || `${more}${one.plane ? "" : message.words}${message.whole || one.plane ? "" : " Its beginning is shown."}`;
        if (!message.refused) one.play();
      }
      if (!message.refused) basin.mark(marked(), active);
    };
  });
  const take = (content, buffers) => {
    if (content.name in shows) shows[content.name](decoded(content.value, buffers));
  };
  model.on("msg:custom", take);

  // Light or dark as the notebook is, which need not be as the system is: its text tells.
  const redraw = () => { for (const one of [basin, ...flights]) one.renew(); };
  const shade = () => {
    if (!el.isConnected) return;
    const [red, green, blue] = getComputedStyle(el).color.match(/[\d.]+/g).map(Number);
    host.className = 0.2126 * red + 0.7152 * green + 0.0722 * blue > 127 ? "dark" : "light";
    redraw();
  };
  const restyled = new MutationObserver(shade);
  for (const whole of [document.documentElement, document.body]) restyled.observe(whole, { attributes: true });
  // A notebook puts it on the page after this, which gives it a size.
  const resized = new ResizeObserver(shade);
  resized.observe(host);

  model.send({ name: "machine", value: { number: 1, settings: {}, held: false, along: "" } });
  return () => {
    model.off("msg:custom", take);
    restyled.disconnect();
    resized.disconnect();
  };
};

export default { render };
