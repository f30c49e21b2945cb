// What is found of one machine of the planar rotor when nothing moves: smallest loss, hardest blow, verdict, and the table of motions.
(() => {
  const exact = { loss: 0, hardest: 0, verdict: 0, proven: 0 };
  carom.on("basin", (message) => {
    if (message.refused) return;
    if (exact.loss !== message.number) carom.panels.tile("lost", message.lost, message.lost_remark);
    if (exact.hardest && exact.hardest !== message.number) carom.panels.pale("hardest", true);
    if (exact.verdict && exact.verdict !== message.number) for (const card of ["headline", "advice", "tried"]) at(card).classList.add("old");
    if (carom.held) for (const what of ["motion", "beside", "figures", "table"]) carom.panels.pale(what, true);
  });
  carom.on("loss", (message) => {
    exact.loss = message.number;
    carom.panels.tile("lost", message.refused ? "–" : message.value, message.refused || message.remark);
  });
  carom.on("hardest", (message) => {
    exact.hardest = message.number;
    carom.panels.pale("hardest", false);
    carom.panels.tile("hardest", message.refused ? "–" : message.value, message.refused || message.remark);
  });
  // Proven is only what is asked for: the picture of another machine, range or kind of disturbance shows nothing of it.
  const asks = "Which kicks come back as a theorem: takes up to half a minute.";
  let wishes = 0;
  if (at("prove")) {
    at("proven").textContent = asks;
    at("prove").addEventListener("click", () => { wishes += 1; carom.requests.wish = { name: "proven", count: wishes }; });
    carom.on("basin", (message) => { if (exact.proven !== message.number) at("proven").textContent = asks; });
    carom.on("proven", (message) => {
      exact.proven = message.number;
      at("proven").textContent = message.refused || `Proven: ${message.words}.`;
    });
  }
  carom.on("verdict", (message) => {
    exact.verdict = message.number;
    for (const card of ["headline", "advice", "tried"]) at(card).classList.remove("old");
    at("headline").textContent = message.refused || message.lead;
    at("advice").textContent = message.advice || "";
    at("tried").hidden = Boolean(message.refused);
    at("survived").replaceChildren(...(message.survived || []).map((words) => {
      const item = document.createElement("li");
      item.textContent = words;
      return item;
    }));
  });
  carom.on("table", carom.unhurried((message) => {
    const body = document.querySelector("#motions tbody");
    carom.panels.shown("table", message);
    if (message.refused) { body.replaceChildren(); at("argument").textContent = message.refused; return; }
    body.replaceChildren(...message.rows.map((row) => {
      const line = document.createElement("tr");
      line.className = row.state === "not possible" ? "impossible" : row.state;
      for (const name of ["name", "state", "period", "size", "impulse", "force", "multipliers", "remark"]) {
        const cell = document.createElement("td");
        cell.textContent = row[name];
        line.append(cell);
      }
      return line;
    }));
    at("argument").textContent = message.argument;
  }));
  carom.idle = () => { if (exact.verdict) carom.sweep.idle(); };
})();
