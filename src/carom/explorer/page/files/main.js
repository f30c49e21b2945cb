// Answers of the server go to the part that shows them.
carom.begin = (requests, answers, parts, plots) => {
  carom.requests = requests;
  carom.begun = { answers, parts, plots };
  carom.begin_plots(parts, plots);
  const shows = {
    state: [carom.panels.state], reply: [carom.controls.reply], basin: [carom.stage.basin, carom.panels.basin], motion: [carom.stage.motions[0]],
    beside: [carom.stage.motions[1]],
    table: [carom.panels.table], loss: [carom.stage.loss, carom.panels.loss], hardest: [carom.panels.hardest], verdict: [carom.panels.verdict],
    diagram: [carom.plots.diagram], exports: [(message) => { carom.panels.exports = message; }],
  };
  for (const [name, parts_] of Object.entries(shows)) {
    answers.properties[name].change.connect(() => {
      const message = answers[name];
      // An answer about a machine that is no longer shown: a newer one is on its way.
      if (message.number !== undefined && message.number < carom.shown && name !== "basin" && name !== "motion" && name !== "beside" && name !== "table") return;
      for (const show of parts_) show(message);
      document.documentElement.dataset[name] = message.number === undefined ? "" : message.number;
    });
  }
  carom.address.begin();
  carom.panels.watch();
};
window.carom = carom;
