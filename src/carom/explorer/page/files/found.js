// What is found of one machine: how it levitates at once, and when nothing moves smallest loss, hardest impact, verdict, and motions.
(() => {
  const row = (cells) => {
    const line = document.createElement("tr");
    line.append(...cells.map((text) => { const cell = document.createElement("td"); cell.textContent = text; return cell; }));
    return line;
  };
  const fill = (name, lines) => document.querySelector(`#${name} tbody`).replaceChildren(...lines);
  const listed = (sentences) => sentences.map((words) => { const item = document.createElement("li"); item.textContent = words; return item; });
  const known = { loss: 0, hardest: 0, verdict: 0, proven: 0 };

  carom.on("levitating", (message) => {
    at("headline").textContent = message.refused || message.lead;
    at("advice").textContent = "";
    at("more").textContent = message.more || "";
    if (known.verdict && known.verdict !== message.number) carom.panels.pale("verdict", true);
    if (message.refused) return;
    document.querySelector(".verdict").classList.toggle("bad", !message.holds);
    carom.panels.tile("damping", message.damping, message.damping_remark);
    carom.panels.tile("clear", message.clearance, message.clearance_remark);
    fill("whirls", message.whirls.map((one) => {
      const line = row([one.frequency, one.sense, one.damping]), bar = document.createElement("td"), drawn = document.createElement("i");
      bar.className = "ratio";
      drawn.style.width = `${Math.min(100, 100 * Math.sqrt(Math.abs(one.ratio)))}%`;
      bar.append(drawn);
      line.append(bar);
      line.classList.toggle("grows", one.ratio < 0);
      return line;
    }));
    if (at("places")) fill("places", message.places.map((one) => row([one.place, one.radius, one.share])));
  });

  carom.on("basin", (message) => {
    if (message.refused) return;
    if (known.loss !== message.number) carom.panels.tile("lost", message.lost, message.lost_remark);
    if (known.hardest && known.hardest !== message.number) carom.panels.pale("hardest", true);
    if (carom.held) for (const what of ["motion", "beside", "figures", "table", "response"]) carom.panels.pale(what, true);
  });
  carom.on("loss", (message) => {
    known.loss = message.number;
    carom.panels.tile("lost", message.refused ? "–" : message.value, message.refused || message.remark);
  });
  carom.on("hardest", (message) => {
    known.hardest = message.number;
    carom.panels.pale("hardest", false);
    carom.panels.tile("hardest", message.refused ? "–" : message.value, message.refused || message.remark);
  });
  // Proven is only what is asked for: the picture of another machine, range or kind of disturbance shows nothing of it.
  const asks = "Proves which kicks come back; takes up to half a minute.";
  let wishes = 0;
  if (at("prove")) {
    at("proven").textContent = asks;
    at("prove").addEventListener("click", () => { wishes += 1; carom.requests.wish = { name: "proven", count: wishes }; });
    carom.on("basin", (message) => { if (known.proven !== message.number) at("proven").textContent = asks; });
    carom.on("proven", (message) => {
      known.proven = message.number;
      at("proven").textContent = message.refused || `Proven: ${message.words}.`;
    });
  }
  carom.on("verdict", (message) => {
    known.verdict = message.number;
    carom.panels.pale("verdict", false);
    if (!message.refused) at("headline").textContent = message.lead;
    at("advice").textContent = message.advice || "";
    at("tried").hidden = Boolean(message.refused);
    at("survived").replaceChildren(...listed(message.survived || []));
  });
  carom.on("response", (message) => {
    carom.panels.shown("response", message);
    const stated = Object.entries(message.stated || { "Response to unbalance": [message.refused] });
    at("stated").replaceChildren(...stated.flatMap(([heading, sentences]) => {
      const title = document.createElement("h4"), list = document.createElement("ul");
      title.textContent = heading;
      list.append(...listed(sentences));
      return [title, list];
    }));
  });
  for (const name of ["motion", "beside"]) {
    carom.on(name, (message) => {
      for (const place of document.querySelectorAll(`[data-of-slot="${name}"]`)) place.textContent = message.planes ? message.planes[+place.dataset.bearing].words : "";
    });
  }
  carom.on("table", carom.unhurried((message) => {
    carom.panels.shown("table", message);
    at("motions-card").hidden = Boolean(message.refused); // it has none that are at rest as the shaft sees them
    fill("motions", (message.rows || []).map((one) => {
      const line = row(["name", "state", "period", "size", "impulse", "force", "multipliers", "remark"].map((name) => one[name]));
      line.className = one.state === "not possible" ? "impossible" : one.state;
      return line;
    }));
    at("argument").textContent = message.argument || "";
  }));
  carom.idle = () => { if (known.verdict) carom.sweep.idle(); };
})();
