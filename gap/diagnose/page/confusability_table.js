// Says what a cell of a table of angles means, under the pointer or by the keyboard: one cell of a table is reached by
// Tab, the others from there by the arrow keys, Home and End. Folded rows are skipped.
(() => {
  const KEYS = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0], Home: [0, -Infinity], End: [0, Infinity] };

  function setUp(table) {
    const columns = [...table.tHead.rows[0].cells].slice(1).map((cell) => cell.textContent);
    const box = table.closest(".angles"), readout = box.querySelector(".readout"), usual = readout.dataset.usual;
    const shownRows = () => [...table.tBodies].flatMap((body) => [...body.rows]).filter((row) => row.offsetParent !== null);
    const cellsOf = (row) => [...row.cells].slice(1);
    let now = null;

    function inWords(cell) {
      const row = cell.parentElement.cells[0].textContent, column = columns[cell.cellIndex - 1];
      if (row === column) return `${row}: itself`;
      const angle = Number(cell.dataset.deg), alike = angle < Number(box.dataset.alike);
      const words = "apart" in cell.dataset ? "alike, but told apart here: at its size the other one explains these runs worse" : alike ? "alike: a small one may be taken for the other" : angle < 60 ? "similar" : "different";
      return `${row} and ${column}: ${angle.toFixed(1)} degrees, ${words}`;
    }
    function show(cell) {
      for (const marked of table.querySelectorAll(".at")) marked.classList.remove("at");
      readout.textContent = cell ? inWords(cell) : usual;
      if (!cell) return;
      cell.parentElement.cells[0].classList.add("at");
      table.tHead.rows[0].cells[cell.cellIndex].classList.add("at");
    }
    function choose(cell) {
      if (now) now.tabIndex = -1;
      now = cell;
      now.tabIndex = 0;
    }

    table.setAttribute("role", "grid");
    for (const cell of table.querySelectorAll("tbody td")) cell.tabIndex = -1;
    const first = shownRows()[0] ?? table.tBodies[0].rows[0];
    choose(cellsOf(first)[0]);
    readout.textContent = usual;
    readout.hidden = false;

    const cellAt = (event) => event.target.closest("tbody td");
    table.addEventListener("pointerover", (event) => show(cellAt(event) ?? (table.contains(document.activeElement) ? now : null)));
    table.addEventListener("pointerleave", () => show(table.contains(document.activeElement) ? now : null));
    table.addEventListener("focusin", (event) => { const cell = cellAt(event); if (cell) { choose(cell); show(cell); } });
    table.addEventListener("focusout", () => show(null));
    table.addEventListener("keydown", (event) => {
      const step = KEYS[event.key], cell = cellAt(event);
      if (!step || !cell) return;
      event.preventDefault();
      const rows = shownRows(), clamp = (value, most) => Math.max(0, Math.min(most, value));
      const row = rows[clamp(rows.indexOf(cell.parentElement) + step[0], rows.length - 1)];
      cellsOf(row)[clamp(cell.cellIndex - 1 + step[1], columns.length - 1)].focus();
    });
    // folding may take away the cell that Tab reaches
    box.querySelector("input")?.addEventListener("change", () => {
      const [row] = shownRows();
      if (row && now.offsetParent === null) choose(cellsOf(row)[0]);
    });
  }
  for (const table of document.querySelectorAll(".angles table")) setUp(table);
})();
