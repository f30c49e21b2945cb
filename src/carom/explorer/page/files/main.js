// Answers of the server go to the parts that show them.
// These are shown although a newer machine is on its way: they follow the hand, or say themselves that they are old.
carom.late = new Set(["basin", "motion", "beside", "table", "levitating"]);
carom.begin = (requests, answers, parts, plots) => {
  carom.requests = requests;
  carom.begun = { answers, parts, plots };
  carom.begin_plots(parts, plots);
  for (const [name, shows] of Object.entries(carom.shows)) {
    answers.properties[name].change.connect(() => {
      const message = answers[name];
      // An answer about a machine that is no longer shown: a newer one is on its way.
      if (message.number !== undefined && message.number < carom.shown && !carom.late.has(name)) return;
      for (const show of shows) show(message);
      document.documentElement.dataset[name] = message.number === undefined ? "" : message.number;
    });
  }
  carom.address.begin();
  carom.panels.watch();
};
window.carom = carom;
