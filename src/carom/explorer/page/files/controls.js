// Sliders and boxes. The machine is sent as the texts of those that were changed; everything else is the file's.
carom.controls = {};
carom.number = 0;
carom.moved = null;
carom.held = false;

(() => {
  const settings = {};
  const rows = [...document.querySelectorAll(".control")].map((row) => {
    const data = row.dataset;
    return { row, name: data.name, unit: data.unit, low: +data.low, high: +data.high, value: +data.value, log: data.log === "1",
      slider: row.querySelector(".slider"), box: row.querySelector(".box"), shown: row.querySelector(".box").value };
  });

  const place = (one, value) => {
    const share = one.log && value > 0 ? Math.log(value / one.low) / Math.log(one.high / one.low) : (value - one.low) / (one.high - one.low);
    return Math.round(1000 * clamp(share, 0, 1));
  };
  const valueAt = (one, where) => {
    const share = where / 1000;
    return Number((one.log ? one.low * (one.high / one.low) ** share : one.low + share * (one.high - one.low)).toPrecision(4));
  };
  carom.controls.value = (name) => {
    const one = rows.find((row) => row.name === name);
    const number = parseFloat(one.box.value);
    return one.held === undefined ? (Number.isFinite(number) ? number : one.value) : one.held;
  };

  const send = (held) => {
    carom.number += 1;
    carom.held = held;
    carom.requests.machine = { number: carom.number, settings: { ...settings }, held, along: carom.moved || "" };
    const words = new URLSearchParams(settings).toString();
    if (!held) history.replaceState(null, "", words ? `#${words}` : location.pathname);
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

  const mark = (one) => one.row.classList.toggle("changed", one.name in settings);
  const moved = (one, held) => {
    const value = valueAt(one, +one.slider.value);
    one.held = value;
    one.box.value = carom.short(value);
    settings[one.name] = `${carom.short(value)} ${one.unit}`.trim();
    carom.moved = one.name;
    mark(one);
    if (carom.showCursor) carom.showCursor(one.name, value);
    if (held) step();
    else { due = false; clearTimeout(timer); waitingFor = 0; one.held = undefined; send(false); }
  };
  const typed = (one) => {
    const text = one.box.value.trim();
    if (text === one.shown && !(one.name in settings)) return;
    if (text === one.shown) delete settings[one.name]; else settings[one.name] = text;
    const number = parseFloat(text);
    one.held = undefined;
    if (Number.isFinite(number)) one.slider.value = place(one, number);
    carom.moved = one.name;
    mark(one);
    send(false);
  };

  for (const one of rows) {
    one.slider.value = place(one, one.value);
    one.slider.addEventListener("input", () => moved(one, true));
    one.slider.addEventListener("change", () => moved(one, false));
    one.box.addEventListener("change", () => typed(one));
  }
  at("controls").addEventListener("submit", (event) => { event.preventDefault(); document.activeElement.blur(); });
  at("reset").addEventListener("click", () => {
    for (const one of rows) {
      delete settings[one.name];
      one.box.value = one.shown;
      one.slider.value = place(one, one.value);
      mark(one);
    }
    send(false);
  });

  carom.controls.problem = (problem) => {
    at("problem").hidden = !problem.text;
    at("problem").textContent = problem.text;
    for (const one of rows) one.box.classList.toggle("wrong", problem.names.includes(one.name));
  };
  // The address keeps what was changed: it can be sent to a colleague, and survives a restart of the server.
  carom.controls.begin = () => {
    for (const [name, text] of new URLSearchParams(location.hash.slice(1))) {
      const one = rows.find((row) => row.name === name);
      if (!one) continue;
      settings[name] = text;
      one.box.value = text.endsWith(` ${one.unit}`) ? text.slice(0, -one.unit.length - 1) : text;
      if (Number.isFinite(parseFloat(text))) one.slider.value = place(one, parseFloat(text));
      carom.moved = name;
      mark(one);
    }
    send(false);
  };
})();
