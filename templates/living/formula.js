// Formulas of the record, LaTeX, as MathML: fractions, roots, indices, letters and words; no more than the record writes.

const GREEK = { alpha: "α", beta: "β", gamma: "γ", delta: "δ", varepsilon: "ε", zeta: "ζ", eta: "η", theta: "θ", lambda: "λ", mu: "μ",
  nu: "ν", xi: "ξ", pi: "π", rho: "ρ", sigma: "σ", tau: "τ", varphi: "φ", chi: "χ", psi: "ψ", omega: "ω", Gamma: "Γ", Delta: "Δ",
  Theta: "Θ", Lambda: "Λ", Sigma: "Σ", Phi: "Φ", Psi: "Ψ", Omega: "Ω" };
const SIGNS = { cdot: "·", times: "×", perp: "⟂", ldots: "…", ",": " ", "%": "%", "#": "#", "&": "&" };

const plain = (text) => String(text).replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;").replace(/"/g, "&quot;");

function mathml(latex) {
  const tokens = latex.match(/\\(?:text|mathrm)\s*\{[^{}]*\}|\\[A-Za-z]+|\\.|\d+(?:[.,]\d+)?|\S/g) ?? [];
  let n = 0;
  const row = (end) => {
    let found = "";
    while (n < tokens.length && tokens[n] !== end) found += scripted();
    n++;
    return `<mrow>${found}</mrow>`;
  };
  const fence = () => { const t = tokens[n++]; return t === "." ? "" : `<mo>${plain(t.replace("\\", ""))}</mo>`; };
  const COMMANDS = { frac: () => `<mfrac>${atom()}${atom()}</mfrac>`, sqrt: () => `<msqrt>${atom()}</msqrt>`, overline: () => `<mover>${atom()}<mo>¯</mo></mover>`,
    left: () => `<mrow>${fence()}${row("\\right")}${fence()}</mrow>` };
  function atom() {
    const t = tokens[n++], name = t.slice(1), [, words] = /^\\(?:text|mathrm)\s*\{(.*)\}$/.exec(t) ?? [];
    if (t === "{") return row("}");
    if (words !== undefined) return `<mtext>${plain(words)}</mtext>`;
    if (/^\d/.test(t)) return `<mn>${t.replace(".", decimal())}</mn>`;
    if (!t.startsWith("\\")) return /\p{L}/u.test(t) ? `<mi>${plain(t)}</mi>` : `<mo>${t === "-" ? "−" : t === "'" ? "′" : plain(t)}</mo>`;
    return COMMANDS[name]?.() ?? (SIGNS[name] ? `<mo>${SIGNS[name]}</mo>` : `<mi>${GREEK[name] ?? plain(name)}</mi>`);
  }
  function scripted() {
    const base = atom(), at = {};
    while (tokens[n] === "_" || tokens[n] === "^") at[tokens[n++]] = atom();
    const tag = (at._ ? "sub" : "") + (at["^"] ? "sup" : "");
    return tag ? `<m${tag}>${base}${at._ ?? ""}${at["^"] ?? ""}</m${tag}>` : base;
  }
  return `<math display="block">${row()}</math>`;
}

// Lettering markup, F_{5} or φ_1, with indices below.
function lettered(markup) {
  return plain(markup).replace(/_\{([^}]*)\}/g, "<sub>$1</sub>").replace(/_([\u0400-\u04ff]+|.)/gu, "<sub>$1</sub>").replace(/\^\{([^}]*)\}/g, "<sup>$1</sup>");
}
