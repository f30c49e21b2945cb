// The pictures: where kicks lead, and the flights after those that are drawn, at each touchdown bearing.  Of two kicks one on what comes back is
// flown first, one on what is lost second.
carom.stage = {};

(() => {
  const canvases = [...document.querySelectorAll("canvas[data-slot]")], slotOf = canvases.map((canvas) => +canvas.dataset.slot);
  const slots = ["motion", "beside"];
  const state = { kind: "kick", largest: null, kicks: null, active: 0, ring: null };
  let asked = 0, opening = 0, smallest = { number: 0, size: 0 }, pointed = null;

  const basin = basinPicture(at("basin"), { onPoint: (kick, chosen, slot) => point(kick, chosen, slot), onRing: (size, done) => pulled(size, done) });
  const flights = canvases.map((canvas, place) => flight(canvas, {
    looks: carom.looks, onTime: (now, end) => { if (carom.plots && flights[place] === carom.motion) carom.plots.now(now, now >= end); },
  }));
  const first = (slot) => flights[slotOf.indexOf(slot)];
  carom.basin = basin;
  carom.flights = flights;
  carom.parts.push(basin.renew, ...flights.map((one) => one.renew));
  const marked = () => state.kicks || slots.map((_, slot) => first(slot).message && first(slot).message.kick).filter(Boolean);
  // The motion that the figures show.
  Object.defineProperty(carom, "motion", { get: () => first(state.active) });

  // A click is not forgotten when the pointer trembles after it.
  let clicked = false;
  const ask = carom.throttled(45, (kick, slot) => {
    asked += 1;
    carom.requests.kick = { number: asked, slot, ...kick, chosen: clicked };
    clicked = false;
  });
  const point = (kick, chosen, slot = null) => {
    const ending = basin.endingOf(kick);
    const place = slot === null ? (ending && ending.back ? 0 : 1) : slot, both = marked();
    if (both.length < slots.length) return;
    state.kicks = both.map((one, other) => (other === place ? kick : one));
    state.active = place;
    pointed = { ...kick, slot: place };
    basin.mark(state.kicks, place);
    clicked ||= chosen;
    ask(kick, place);
    // Arrow keys take many steps, of which the address keeps the last.
    if (chosen) carom.address.keep(slot === null);
  };

  const legendOf = (message) => {
    const [one] = message.nouns, rows = [];
    if (message.contact_free > 0) rows.push(["dash", "proven never to touch"]);
    if (basin.veiled()) rows.push(["pale", `pale: nothing is proven; proven to come back ${basin.proven.share}`]);
    if (message.required > 0) rows.push(["must", `${message.required > message.largest * 1.0001 ? "out of the picture: " : ""}must survive ${short(message.required, 3)} ${message.unit}`]);
    if (basin.ring > 0) rows.push(["lost", state.ring ? `chosen: ${short(basin.ring, 3)} ${message.unit}` : `smallest ${one} that does not come back: ${short(basin.ring, 3)} ${message.unit}`]);
    return rows;
  };
  // Rows stay while the motions are the same: only the shares change then.
  let listed = "", shares = [];
  const legend = (message) => {
    const extra = legendOf(message), names = JSON.stringify([extra, ...message.endings.map((one) => [one.words, one.colour, one.hatch])]);
    if (names !== listed) {
      listed = names;
      shares = message.endings.map(() => document.createElement("span"));
      const rows = message.endings.map((one, place) => {
        const item = document.createElement("li"), swatch = document.createElement("canvas"), words = document.createElement("span");
        item.append(swatch, words, shares[place]);
        words.textContent = one.words;
        swatch.width = swatch.height = 24;
        const pen = swatch.getContext("2d");
        pen.fillStyle = pen.createPattern(tile(one.colour, one.hatch).canvas, "repeat");
        pen.fillRect(0, 0, 24, 24);
        return item;
      });
      rows.push(...extra.map(([look, said]) => {
        const item = document.createElement("li"), sign = document.createElement("i"), words = document.createElement("span");
        sign.className = `ring ${look}`;
        words.textContent = said;
        item.append(sign, words);
        return item;
      }));
      at("legend").replaceChildren(...rows);
    }
    message.endings.forEach((one, place) => { shares[place].textContent = `${short(100 * one.share, 3)} %`; });
  };

  // The ring stands at the smallest that is lost, until it is pulled to a size of which one wishes to know what comes back inside.
  const ringOf = (message) => state.ring || (message.coarse ? 0 : smallest.number >= message.number ? smallest.size : message.lost_size);
  const note = () => {
    const message = basin.message, [one, many] = message.nouns, [share, cells] = basin.ring ? basin.shareWithin(basin.ring) : [1, 0];
    at("ring-note").textContent = basin.ring
      ? `${message.coarse ? "Coarse so far: about " : ""}${share > 0.999 && share < 1 ? "almost 100" : short(100 * share, 3)} % of the ${many} inside the ring come back${cells < 30 ? " (few cells; narrow the range)" : ""}. Drag the ring to ask about another size.`
      : message.coarse ? "The picture is still coarse: what comes back inside a ring is stated when it is fine." : `All of the ${many} tried come back.`;
    legend(message);
  };
  const ringed = () => { basin.setRing(ringOf(basin.message)); note(); };
  const pulled = (size, done) => {
    state.ring = size;
    ringed();
    if (done) carom.address.keep();
  };
  carom.on("loss", (message) => {
    if (message.refused) return;
    smallest = { number: message.number, size: message.size };
    if (basin.message) ringed();
  });

  carom.on("proven", (message) => {
    if (message.refused) return;
    basin.prove(message);
    if (basin.message) note();
  });

  const ranged = (message) => {
    opening = message.opening;
    if (document.activeElement !== at("range") || !carom.held) at("range").value = Math.round(1000 * Math.log(message.largest / opening * 8) / Math.log(64));
    at("range-words").textContent = `up to ${short(message.largest, 3)} ${message.unit}`;
  };
  carom.on("basin", (message) => {
    if (basin.message && message.number < basin.message.number) return;
    if (message.refused) { at("sentence").textContent = message.refused; carom.controls.arrived(message.number); return; }
    for (const one of flights) one.rest = message.rest_position && { position: message.rest_position, colour: message.legend_rest };
    // All at once, so that it is drawn once.
    basin.kicks = marked();
    basin.ring = ringOf(message);
    basin.show(message);
    note();
    ranged(message);
    at("rest").textContent = message.rest;
    at("kind").value = message.kind;
    carom.controls.arrived(message.number);
  });

  // The motion after one of both; a newer wish keeps its own mark.
  const moved = (slot) => (message) => {
    const one = first(slot), newest = !pointed || pointed.slot !== slot || !message.kick || (pointed.first === message.kick.first && pointed.second === message.kick.second);
    const all = flights.filter((_, place) => slotOf[place] === slot);
    all.forEach((each, place) => each.show(message.planes ? { ...message, ...message.planes[place] } : message));
    carom.panels.shown(slots[slot], message);
    at(`${slots[slot]}-words`).textContent = message.refused || message.words + (message.whole ? "" : " Its beginning is shown.");
    at(`${slots[slot]}-title`).textContent = message.refused ? "not possible" : message.outcome === "levitated" ? "comes back" : "does not come back";
    at(`${slots[slot]}-sign`).style.background = message.refused ? "" : message.colour;
    if (message.refused) return;
    if (!state.kicks || newest) basin.mark(marked(), state.active);
    if (carom.plots && slot === state.active) carom.plots.motion(message);
    for (const each of all) if (carom.held) each.finish(false); else each.play();
    const slower = one.slower();
    at("pace").textContent = slower > 1.5 ? `slowed down ${short(slower, 2)} times` : "";
  };
  slots.forEach((name, slot) => carom.on(name, moved(slot)));
  at("replay").addEventListener("click", () => { for (const one of flights) one.play(); });
  const choices = [...document.querySelectorAll('input[name="frame"]')], frames = choices.map((one) => one.value);
  for (const choice of choices) {
    if (choice.checked) for (const one of flights) one.frame = choice.value;
    choice.addEventListener("change", () => { for (const one of flights) one.turnWith(choice.value); carom.address.keep(); });
  }

  at("range").addEventListener("input", () => {
    state.largest = Number((opening / 8 * 64 ** (at("range").value / 1000)).toPrecision(3));
    at("range-words").textContent = `up to ${short(state.largest, 3)} ${basin.message.unit}`;
    carom.controls.ask(true);
  });
  at("range").addEventListener("change", () => carom.controls.ask(false));
  at("kind").addEventListener("change", () => {
    Object.assign(state, { kind: at("kind").value, largest: null, kicks: null, active: 0, ring: null });
    pointed = null;
    for (const one of flights) one.clear();
    carom.controls.ask(false);
  });

  carom.stage.view = () => ({
    kind: state.kind, largest: state.largest, active: state.active, kicks: state.kicks && state.kicks.map((kick) => [kick.first, kick.second]),
  });
  const kept = ["kick", "other"]; // names in the address
  const pair = (kick) => `${short(kick.first)},${short(kick.second)}`;
  carom.stage.kept = () => ({
    ...(state.kind !== "kick" && { show: state.kind }), ...(state.largest && { range: short(state.largest) }),
    ...(state.kicks && Object.fromEntries(state.kicks.map((kick, slot) => [kept[slot], pair(kick)]))), ...(state.ring && { ring: short(state.ring) }),
    ...(!choices.find((one) => one.checked).defaultChecked && { frame: flights[0].frame }),
  });
  carom.stage.reset = () => carom.stage.restore({});
  carom.stage.restore = (given) => {
    const number = (text) => (Number(text) > 0 && Number.isFinite(Number(text)) ? Number(text) : null);
    const kick = (text) => { const [first, second] = (text || "").split(",").map(Number); return Number.isFinite(first) && Number.isFinite(second) && text ? { first, second } : null; };
    const both = slots.map((_, slot) => kick(given[kept[slot]])), known = [...at("kind").options].some((one) => one.value === given.show);
    const frame = frames.includes(given.frame) ? given.frame : choices.find((one) => one.defaultChecked).value;
    for (const one of choices) one.checked = one.value === frame;
    for (const one of flights) if (one.frame !== frame) one.turnWith(frame);
    pointed = null;
    if (both.includes(null)) for (const one of flights) one.clear();
    Object.assign(state, { kind: known ? given.show : "kick", largest: number(given.range), kicks: both.includes(null) ? null : both, active: 0, ring: number(given.ring) });
    if (basin.message) { basin.mark(marked(), 0); ringed(); }
  };
})();
