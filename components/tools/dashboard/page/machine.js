// The state machine of the mission (Fig. 3 of the paper) as a diagram with the present state lit.

const svg = "http://www.w3.org/2000/svg";
const wide = { cell: { width: 150, height: 74 }, box: { width: 118, height: 38 }, letters: 13 };
// On a phone the boxes are narrow and high, so that their texts are as large as those around the diagram.
const narrow = { cell: { width: 96, height: 88 }, box: { width: 82, height: 54 }, letters: 11 };

function make(name, attributes, parent) {
  const node = document.createElementNS(svg, name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  parent?.append(node);
  return node;
}

/** The point where the line from the middle of a box towards (x, y) leaves the box. */
function border(box, [cx, cy], [x, y], gap) {
  const dx = x - cx;
  const dy = y - cy;
  const share = Math.min((box.width / 2 + gap) / Math.abs(dx || 1e-9), (box.height / 2 + gap) / Math.abs(dy || 1e-9));
  return [cx + dx * share, cy + dy * share];
}

/** The words in lines of at most `letters` characters; a longer word has a line of its own. */
function lines(text, letters) {
  const made = [];
  for (const word of text.split(" ")) {
    const last = made.length - 1;
    if (last >= 0 && made[last].length + 1 + word.length <= letters) made[last] += ` ${word}`;
    else made.push(word);
  }
  return made;
}

export class Machine {
  constructor(parent, description) {
    this.parent = parent;
    this.description = description;
    this.known = description.states;
    const phone = matchMedia("(max-width: 600px)");
    phone.addEventListener("change", () => this.draw(phone.matches ? narrow : wide));
    this.draw(phone.matches ? narrow : wide);
  }

  draw(size) {
    const { description } = this;
    const { cell } = size;
    const lit = this.present;
    this.size = size;
    this.present = null;
    this.boxes = {};
    this.arrows = []; // {from, to, path}
    const width = description.columns * cell.width;
    const height = description.rows * cell.height;
    const root = make("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "states of the mission" });
    const marks = make("defs", {}, root);
    for (const kind of ["", "out"]) {
      const tip = make("marker", { id: `tip${kind}`, viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 6,
        markerHeight: 6, orient: "auto" }, marks);
      make("path", { d: "M0,0 L8,4 L0,8 z", class: `tip ${kind}` }, tip);
    }
    for (const [from, to] of description.transitions) this.arrows.push({ from, to, path: this.arrow(root, from, to) });
    for (const name of Object.keys(this.known)) this.boxes[name] = this.state(root, name);
    this.parent.replaceChildren(root);
    if (lit !== null && lit !== undefined) this.show(lit);
  }

  middle(name) {
    const [column, row] = this.known[name];
    const { cell } = this.size;
    return [(column + 0.5) * cell.width, (row + 0.5) * cell.height];
  }

  /** Bent to the right of its direction, so that the two ways between two states lie beside each other. */
  arrow(root, from, to) {
    const [a, b] = [this.middle(from), this.middle(to)];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    const bend = 10 + length * 0.1;
    const turn = [(a[0] + b[0]) / 2 - ((b[1] - a[1]) / length) * bend, (a[1] + b[1]) / 2 + ((b[0] - a[0]) / length) * bend];
    const begin = border(this.size.box, a, turn, 0);
    const end = border(this.size.box, b, turn, 2);
    return make("path", { d: `M${begin} Q${turn} ${end}`, class: "arrow", "marker-end": "url(#tip)" }, root);
  }

  state(root, name) {
    const [x, y] = this.middle(name);
    const { box } = this.size;
    const group = make("g", { class: "state", "data-state": name }, root);
    make("rect", { x: x - box.width / 2, y: y - box.height / 2, width: box.width, height: box.height, rx: 8 }, group);
    const texts = lines(name, this.size.letters);
    texts.forEach((line, i) => {
      const text = make("text", { x, y: y + 5 + (i - (texts.length - 1) / 2) * 15, "text-anchor": "middle" }, group);
      text.textContent = line;
    });
    return group;
  }

  /** Lights a state and the ways out of it. Returns false if the diagram does not know the state. */
  show(name) {
    if (name === this.present) return name in this.known;
    this.boxes[this.present]?.classList.remove("present");
    this.boxes[name]?.classList.add("present");
    for (const { from, path } of this.arrows) {
      path.classList.toggle("out", from === name);
      path.setAttribute("marker-end", from === name ? "url(#tipout)" : "url(#tip)");
    }
    this.present = name;
    return name in this.known;
  }
}
