// Lists the parameters of a run that may change while it runs, and changes them.
import { rows } from "./texts.js";

const element = (id) => document.getElementById(id);

export class Parameters {
  /** `call(service, request)` calls a service, shows its answer, and returns it; null: it was refused. */
  constructor(connection, call) {
    this.connection = connection;
    this.call = call;
    this.list = [];
    element("parameters").addEventListener("toggle", () => element("parameters").open && this.read());
    element("parameter_filter").addEventListener("input", () => this.show());
    element("parameter_read").addEventListener("click", () => this.read());
  }

  async read() {
    if (!this.connection.has("param_list")) return;
    element("parameter_count").textContent = "reading";
    try {
      this.list = JSON.parse(await this.connection.call("param_list", {}));
      element("parameter_count").textContent = `${this.list.length} parameters`;
    } catch (error) {
      element("parameter_count").textContent = error.message;
    }
    this.show();
  }

  /** These parameters have other values, also if another client has changed them. */
  take(values) {
    for (const { name, value } of values) {
      const parameter = this.list.find((each) => each.name === name);
      if (parameter) Object.assign(parameter, { value, pending: null });
    }
    this.show();
  }

  show() {
    const filter = element("parameter_filter").value.trim();
    const shown = this.list.filter((parameter) => parameter.name.includes(filter));
    rows(element("parameter_rows"), shown, (row, parameter) => {
      if (row.children.length === 0) this.build(row);
      const [name, cell, unit, accepted] = row.children;
      name.textContent = parameter.name;
      row.title = parameter.doc;
      row.className = parameter.value === parameter.default ? "" : "changed";
      const input = cell.firstChild;
      input.dataset.name = parameter.name;
      if (document.activeElement !== input) input.value = parameter.pending?.value ?? parameter.value;
      input.setAttribute("aria-label", `${parameter.name} [${parameter.unit}]`);
      unit.textContent = parameter.unit;
      const choices = parameter.choices ?? [];
      input.dataset.choices = choices.join(" ");
      accepted.textContent =
        choices.length > 0
          ? `one of ${choices.join(", ")}`
          : `${parameter.whole ? "whole, " : ""}${parameter.minimum} to ${parameter.maximum}`;
    });
  }

  build(row) {
    for (let i = 0; i < 4; ++i) row.append(document.createElement("td"));
    const input = document.createElement("input");
    Object.assign(input, { type: "text", inputMode: "decimal", size: 8 });
    // The run decides what it accepts, so its reason is shown for a refused value.
    input.addEventListener("change", async () => {
      const text = input.value.trim();
      const choice = text ? input.dataset.choices.split(" ").indexOf(text) : -1;
      const value = choice >= 0 ? choice : Number(text.replace(",", "."));
      await this.call("param_set", { name: input.dataset.name, value: text ? value : null });
      await this.read();
    });
    row.children[1].append(input);
  }
}
