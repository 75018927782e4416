// Formulas of the record, LaTeX, as MathML: fractions, roots, indices, letters and words; no more than the record writes.

const GREEK = { alpha: "α", beta: "β", gamma: "γ", delta: "δ", varepsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", lambda: "λ", mu: "μ",
  nu: "ν", xi: "ξ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", varphi: "φ", chi: "χ", psi: "ψ", omega: "ω", Gamma: "Γ", Delta: "Δ",
  Theta: "Θ", Lambda: "Λ", Sigma: "Σ", Phi: "Φ", Psi: "Ψ", Omega: "Ω" };
const SIGNS = { cdot: "·", times: "×", perp: "⟂", ldots: "…", ",": " ", "%": "%", "#": "#", "&": "&" };

const plain = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");

function mathml(latex) {
  const tokens = latex.match(/\\[A-Za-z]+|\\.|\d+(?:[.,]\d+)?|[^\s]|\s+/g) ?? [];
  let n = 0;
  const peek = () => { while (n < tokens.length && !tokens[n].trim()) n++; return tokens[n]; };
  const raw = () => {
    let text = "", depth = 0;
    do {
      const t = tokens[n++];
      if (t === "{" && depth++ === 0) continue;
      if (t === "}" && --depth === 0) break;
      text += t;
    } while (n < tokens.length && depth > 0);
    return text;
  };
  const group = () => {
    if (peek() !== "{") return atom();
    n++;
    const found = row("}");
    n++;
    return found;
  };
  const fence = () => { const t = peek(); n++; return t === "." ? "" : `<mo>${plain(t.replace("\\", ""))}</mo>`; };
  function atom() {
    const t = peek();
    n++;
    if (t === "{") { n--; return group(); }
    if (/^\d/.test(t)) return `<mn>${t.replace(".", decimal())}</mn>`;
    if (!t.startsWith("\\")) return /[\p{L}]/u.test(t) ? `<mi>${plain(t)}</mi>` : `<mo>${t === "-" ? "−" : t === "'" ? "′" : plain(t)}</mo>`;
    const name = t.slice(1);
    if (name === "frac") return `<mfrac>${group()}${group()}</mfrac>`;
    if (name === "sqrt") return `<msqrt>${group()}</msqrt>`;
    if (name === "overline") return `<mover>${group()}<mo>¯</mo></mover>`;
    if (name === "text" || name === "mathrm") { peek(); return `<mtext>${plain(raw())}</mtext>`; }
    if (name === "left") { const open = fence(), inner = row("\\right"); n++; return `<mrow>${open}${inner}${fence()}</mrow>`; }
    if (GREEK[name]) return `<mi>${GREEK[name]}</mi>`;
    if (SIGNS[name]) return `<mo>${SIGNS[name]}</mo>`;
    return `<mi>${plain(name)}</mi>`;
  }
  function row(end) {
    let found = "";
    while (peek() !== undefined && peek() !== end) {
      let one = atom(), below = "", above = "";
      while (peek() === "_" || peek() === "^") {
        const sign = peek();
        n++;
        if (sign === "_") below = group(); else above = group();
      }
      if (below && above) one = `<msubsup>${one}${below}${above}</msubsup>`;
      else if (below) one = `<msub>${one}${below}</msub>`;
      else if (above) one = `<msup>${one}${above}</msup>`;
      found += one;
    }
    return `<mrow>${found}</mrow>`;
  }
  return `<math display="block">${row()}</math>`;
}

// Lettering markup, F_{5} or φ_1, with indices below.
function lettered(markup) {
  return plain(markup).replace(/_\{([^}]*)\}/g, "<sub>$1</sub>").replace(/_([\u0400-\u04ff]+|.)/gu, "<sub>$1</sub>").replace(/\^\{([^}]*)\}/g, "<sup>$1</sup>");
}
