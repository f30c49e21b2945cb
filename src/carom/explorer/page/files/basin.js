// The plane of kicks: cells coloured by where they lead, and the kick that is shown.
carom.basin = { message: null, kick: { radial: 0.31, tangential: 0.12 } };

(() => {
  const canvas = at("basin"), left = 54, below = 40, edge = 6;
  let frame = null, layer = null;

  // Cells with their textures in pixels of the screen, painted once for a picture and a size.
  const paint = (message, wide) => {
    const n = message.size, image = new ImageData(wide, wide), pixels = new Uint32Array(image.data.buffer);
    const cell = Array.from({ length: wide }, (_, place) => Math.floor(((place + 0.5) * n) / wide));
    const tiles = message.endings.map((one) => carom.tile(one.colour, one.hatch));
    for (let row = 0; row < wide; row += 1) {
      const below = (n - 1 - cell[row]) * n;
      for (let column = 0; column < wide; column += 1) {
        const tile = tiles[message.cells[below + cell[column]]];
        if (tile) pixels[row * wide + column] = tile.pixels[(row % tile.side) * tile.side + (column % tile.side)];
      }
    }
    const sheet = document.createElement("canvas");
    sheet.width = sheet.height = wide;
    sheet.getContext("2d").putImageData(image, 0, 0);
    return { message, sheet };
  };

  const draw = () => {
    const message = carom.basin.message;
    const [pen, side] = carom.square(canvas);
    const width = side - left - edge, top = edge, height = side - below - edge;
    const span = Math.min(width, height), x0 = left, y0 = top;
    frame = { x0, y0, span };
    pen.clearRect(0, 0, side, side);
    pen.font = "12px system-ui, sans-serif";
    if (!message) { pen.fillStyle = colour("void"); pen.fillRect(x0, y0, span, span); return; }
    const wide = Math.round(span * (canvas.width / side));
    if (layer === null || layer.message !== message || layer.sheet.width !== wide) layer = paint(message, wide);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(layer.sheet, x0, y0, span, span);
    const toX = (share) => x0 + span * (share + 1) / 2, toY = (share) => y0 + span * (1 - share) / 2;
    // Rings of equal size, and the axes.
    const step = carom.step(message.largest, 3);
    pen.save();
    pen.beginPath(); pen.rect(x0, y0, span, span); pen.clip();
    pen.strokeStyle = "rgba(255,255,255,.42)"; pen.lineWidth = 1;
    for (let size = step; size <= message.largest; size += step) {
      pen.beginPath(); pen.arc(toX(0), toY(0), span * size / message.largest / 2, 0, 7); pen.stroke();
    }
    pen.beginPath(); pen.moveTo(toX(0), y0); pen.lineTo(toX(0), y0 + span); pen.moveTo(x0, toY(0)); pen.lineTo(x0 + span, toY(0)); pen.stroke();
    if (message.harmless > 0) {
      pen.setLineDash([5, 4]); pen.strokeStyle = "rgba(0,0,0,.75)"; pen.lineWidth = 1.5;
      pen.beginPath(); pen.arc(toX(0), toY(0), span * message.harmless / 2, 0, 7); pen.stroke(); pen.setLineDash([]);
    }
    // From where angles count: the x axis that turns with the shaft, as in `carom simulate --kick`.
    const [across, up] = [message.outward[0], -message.outward[1]];
    pen.font = "600 12px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
    for (const [line, ink] of [[4, "rgba(0,0,0,.65)"], [2, "#fff"]]) {
      pen.strokeStyle = ink; pen.lineWidth = line;
      pen.beginPath(); pen.moveTo(toX(0.92 * across), toY(0.92 * up)); pen.lineTo(toX(across), toY(up)); pen.stroke();
    }
    pen.strokeStyle = "rgba(0,0,0,.75)"; pen.lineWidth = 3; pen.fillStyle = "#fff";
    pen.strokeText("0°", toX(0.84 * across), toY(0.84 * up));
    pen.fillText("0°", toX(0.84 * across), toY(0.84 * up));
    pen.font = "12px system-ui, sans-serif";
    const kick = carom.basin.kick, kx = toX(kick.radial), ky = toY(kick.tangential);
    for (const [line, ink] of [[4, "rgba(0,0,0,.65)"], [2, "#fff"]]) {
      pen.strokeStyle = ink; pen.lineWidth = line;
      pen.beginPath(); pen.moveTo(toX(0), toY(0)); pen.lineTo(kx, ky); pen.stroke();
      pen.beginPath(); pen.arc(kx, ky, 6, 0, 7); pen.stroke();
    }
    pen.restore();
    pen.fillStyle = colour("soft"); pen.textBaseline = "top"; pen.textAlign = "center";
    for (let value = -Math.floor(message.largest / step) * step; value <= message.largest; value += step) {
      const share = value / message.largest;
      pen.textAlign = "center"; pen.textBaseline = "top"; pen.fillText(carom.short(value, 3), clamp(toX(share), x0 + 8, side - 14), y0 + span + 4);
      pen.textAlign = "right"; pen.textBaseline = "middle"; pen.fillText(carom.short(value, 3), x0 - 5, clamp(toY(share), y0 + 6, y0 + span - 6));
    }
    pen.textAlign = "center"; pen.textBaseline = "alphabetic";
    pen.fillText(`kick outward (${message.unit})`, x0 + span / 2, y0 + span + 32);
    pen.save(); pen.translate(11, y0 + span / 2); pen.rotate(-Math.PI / 2); pen.fillText(`kick with the rotation (${message.unit})`, 0, 0); pen.restore();
  };

  // Rows stay while the motions are the same: only the shares change then.
  let listed = "", shares = [];
  const legend = (message) => {
    const names = JSON.stringify([message.harmless > 0, ...message.endings.map((one) => [one.words, one.colour, one.hatch])]);
    if (names !== listed) {
      listed = names;
      shares = message.endings.map(() => document.createElement("span"));
      const rows = message.endings.map((one, place) => {
        const item = document.createElement("li"), swatch = document.createElement("canvas"), words = document.createElement("span");
        item.append(swatch, words, shares[place]);
        words.textContent = one.words;
        swatch.width = swatch.height = 24;
        const pen = swatch.getContext("2d");
        pen.fillStyle = pen.createPattern(carom.tile(one.colour, one.hatch).canvas, "repeat");
        pen.fillRect(0, 0, 24, 24);
        return item;
      });
      if (message.harmless > 0) {
        const item = document.createElement("li");
        item.innerHTML = '<i class="ring"></i><span>inside the dashed ring: proven never to touch</span>';
        rows.push(item);
      }
      at("legend").replaceChildren(...rows);
    }
    message.endings.forEach((one, place) => { shares[place].textContent = `${carom.short(100 * one.share, 3)} %`; });
  };

  carom.basin.show = (message) => {
    if (carom.basin.message && message.number < carom.basin.message.number) return;
    if (message.refused) { at("sentence").textContent = message.refused; return; }
    carom.basin.message = message;
    draw();
    legend(message);
    at("rest").textContent = message.rest;
    carom.controls.arrived(message.number);
  };
  carom.basin.mark = (kick) => { carom.basin.kick = kick; draw(); };

  const ask = carom.throttled(45, (kick, chosen) => {
    carom.kicks = (carom.kicks || 0) + 1;
    carom.requests.kick = { number: carom.kicks, radial: kick.radial, tangential: kick.tangential, chosen };
  });
  const point = (event, chosen) => {
    if (!frame) return;
    const box = canvas.getBoundingClientRect();
    const kick = { radial: 2 * (event.clientX - box.left - frame.x0) / frame.span - 1, tangential: 1 - 2 * (event.clientY - box.top - frame.y0) / frame.span };
    if (Math.abs(kick.radial) > 1 || Math.abs(kick.tangential) > 1) return;
    carom.basin.mark(kick);
    ask(kick, chosen);
  };
  canvas.addEventListener("pointermove", (event) => { if (event.pointerType !== "touch") point(event, false); });
  canvas.addEventListener("click", (event) => point(event, true));
  canvas.addEventListener("keydown", (event) => {
    const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    if (!move) return;
    event.preventDefault();
    const kick = carom.basin.kick;
    carom.basin.mark({ radial: clamp(kick.radial + 0.02 * move[0], -1, 1), tangential: clamp(kick.tangential + 0.02 * move[1], -1, 1) });
    ask(carom.basin.kick, true);
  });
  carom.parts.push(draw);
})();
