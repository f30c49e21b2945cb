// Sliders and boxes. The machine is sent as the texts of those that were changed; everything else is the file's.
carom.controls = { settings: {}, notice: "" };
carom.number = 0;
carom.shown = 0; // the number of the machine that the server shows: a later one may have been refused
carom.moved = null;
carom.held = false;

(() => {
  const settings = carom.controls.settings;
  const rows = [...document.querySelectorAll(".control")].map((row) => {
    const data = row.dataset;
    return { row, name: data.name, unit: data.unit, low: +data.low, high: +data.high, value: +data.value, log: data.log === "1", among: data.among,
      now: +data.value, slider: row.querySelector(".slider"), box: row.querySelector(".box"), shown: row.querySelector(".box").value };
  });

  // As the server writes them: many digits are no help.
  const typing = (value) => (Math.abs(value) >= 1e8 ? Number(value.toPrecision(4)).toExponential().replace("e+", "e") : short(value));
  const place = (one, value) => {
    const share = one.log && value > 0 ? Math.log(value / one.low) / Math.log(one.high / one.low) : (value - one.low) / (one.high - one.low);
    return Math.round(1000 * clamp(share, 0, 1));
  };
  const valueAt = (one, where) => {
    const share = where / 1000;
    return Number((one.log ? one.low * (one.high / one.low) ** share : one.low + share * (one.high - one.low)).toPrecision(4));
  };
  carom.controls.value = (name) => rows.find((row) => row.name === name).now;

  const send = (held) => {
    carom.number += 1;
    carom.held = held;
    carom.requests.machine = { number: carom.number, settings: { ...settings }, held, along: carom.moved || "", view: carom.stage.view() };
  };
  // While a slider is held the next step is sent when the picture of the last one is there, or after a moment.
  let due = false, waitingFor = 0, timer = 0;
  const step = () => {
    if (waitingFor > (carom.seen || 0)) { due = true; return; }
    due = false;
    send(true);
    waitingFor = carom.number;
    clearTimeout(timer);
    timer = setTimeout(() => { waitingFor = 0; if (due) step(); }, 400);
  };
  carom.controls.arrived = (number) => { carom.seen = number; if (due && number >= waitingFor) step(); };
  // Ask for what is set now: step by step while something is held, and else all of it, which the address then keeps.
  carom.controls.ask = (held, keep = true) => {
    if (held) { step(); return; }
    due = false;
    clearTimeout(timer);
    waitingFor = 0;
    send(false);
    if (keep) carom.address.keep();
  };

  const plain = /^[\s\d.,'+-]*(e[+-]?\d+)?\s*$/i;
  const mark = (one) => {
    one.row.classList.toggle("changed", one.name in settings);
    one.row.classList.toggle("own-unit", !plain.test(one.box.value));
  };
  // What is set for all parts holds for each of them.
  const together = (whole) => {
    for (const one of rows.filter((row) => row.among === whole.name)) {
      delete settings[one.name];
      mark(one);
    }
  };
  const moved = (one, held, keep = true) => {
    const value = valueAt(one, +one.slider.value);
    one.now = value;
    one.box.value = typing(value);
    settings[one.name] = `${typing(value)} ${one.unit}`.trim();
    carom.moved = one.name;
    mark(one);
    together(one);
    if (carom.showCursor) carom.showCursor(one.name, value);
    carom.controls.ask(held, keep);
  };
  const typed = (one) => {
    const text = one.box.value.trim();
    if (text === one.shown && !(one.name in settings)) return;
    if (text === one.shown) delete settings[one.name]; else settings[one.name] = text;
    carom.moved = one.name;
    mark(one);
    together(one);
    carom.controls.ask(false);
  };

  for (const one of rows) {
    one.slider.value = place(one, one.value);
    one.slider.addEventListener("input", () => moved(one, true));
    one.slider.addEventListener("change", () => moved(one, false));
    one.box.addEventListener("change", () => typed(one));
  }
  at("controls").addEventListener("submit", (event) => { event.preventDefault(); document.activeElement.blur(); });
  // Other values in place of those that are set: text by name, as the address keeps it.
  carom.controls.replace = (texts) => {
    for (const one of rows) {
      delete settings[one.name];
      const text = texts[one.name];
      if (text === undefined) one.box.value = one.shown;
      else {
        settings[one.name] = text;
        // The unit stands beside the box; that of "90 g mm" is another one.
        const number = text.endsWith(` ${one.unit}`) ? text.slice(0, -one.unit.length - 1) : "";
        one.box.value = number && Number.isFinite(Number(number)) ? number : text;
        carom.moved = one.name;
      }
      mark(one);
    }
  };
  at("reset").addEventListener("click", () => {
    carom.controls.replace({});
    carom.stage.reset();
    carom.controls.ask(false);
  });
  // Move a slider by itself, to a share of its length; back to the file without one.
  carom.controls.glide = (name, share) => {
    const one = rows.find((row) => row.name === name);
    if (share === null) { carom.controls.replace({}); carom.controls.ask(false); return; }
    one.slider.value = Math.round(1000 * share);
    moved(one, true);
  };
  carom.controls.share = (name) => +rows.find((row) => row.name === name).slider.value / 1000;

  // The server reads what was typed: its values place the sliders and the mark in the diagram.
  carom.on("reply", (reply) => {
    carom.shown = reply.shown;
    const words = reply.text || carom.controls.notice;
    carom.controls.notice = "";
    at("problem").hidden = !words;
    at("problem").textContent = words;
    for (const one of rows) {
      one.box.classList.toggle("wrong", reply.names.includes(one.name));
      if (carom.held || reply.number < carom.number) continue;
      const value = reply.values[one.name];
      // Of all parts together, where they differ.
      if (value === null) { one.box.value = ""; one.box.placeholder = "differ"; continue; }
      if (!one.box.value) one.box.value = typing(value);
      one.now = value;
      one.slider.value = place(one, one.now);
      // A box follows what was set of all parts together.
      if (one.among && !(one.name in settings)) one.box.value = one.among in settings ? typing(value) : one.shown;
      if (carom.showCursor) carom.showCursor(one.name, one.now);
    }
  });
})();
