// Orders what a search finds. Everyday words lead to the pages that explain, first to those with the
// words in a heading; what looks like a name in code leads to where it is described, as Sphinx has it.

var Scorer = (() => {
  // Of a name in code: an underscore, a dot, or a capital inside.
  const CODE = /[_.(]|\w[A-Z]/;
  // What is made of the code says little to somebody who does not know its names.
  const WEIGHTS = [
    [/^reference\/generated\//, -12],
    [/^reference\//, -3],
    [/^(troubleshooting|glossary)$/, 5],
    [/^(concepts|start|no-device|cockpit|effects|stability|install|compose)$/, 3],
    [/^tutorials\//, -1],
  ];
  // What people call it who do not know what the headings call it.
  const ABOUT = {
    "accuracy": "how exact error budget",
    "bridge-a-device": "own device arm vendor SDK driver motor",
    "citing": "reference paper author bibtex",
    "comparison": "alternative versus limits",
    "compose": "own plant robot MultibodyPlant",
    "device-twin": "encoder noise",
    "effects": "friction shading texture braking weight gravity",
    "glossary": "unit symbol frame notation force on the hand",
    "gradients": "AutoDiff Jacobian linearize",
    "install": "pip wheel macOS Windows Python version",
    "no-device": "simulate device browser",
    "no-fall-through": "thin wall plate tunnel",
    "record-replay": "record log a run CSV",
    "stability": "network delay latency vibration passive",
    "troubleshooting": "buzzing vibration tremor hum weak peg hole tolerance inch millimetre unit",
    "under-load": "slow overrun",
  };
  const IN_HEADING = 12, IN_TITLE = 5, OBJECT = -10;
  let query = "";
  let words = [];
  let headings = null;

  function stems(text) {
    const stemmer = new Stemmer();
    return splitQuery(text.toLowerCase()).filter(word => !stopwords.has(word)).map(word => stemmer.stemWord(word));
  }

  /** The stems of the headings of each page, by its name. */
  function readHeadings() {
    const {alltitles, docnames} = Search._index;
    const found = {};
    for (const [page, text] of Object.entries(ABOUT)) found[page] = [stems(text)];
    for (const [heading, places] of Object.entries(alltitles))
      for (const [file] of places) (found[docnames[file]] ??= []).push(stems(heading));
    return found;
  }

  /** The share of the words that is in a text. */
  function share(text) {
    return words.filter(word => text.includes(word)).length / Math.max(words.length, 1);
  }

  return {
    objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
    title: 15, partialTitle: 7, term: 5, partialTerm: 2,

    score([page, title, anchor, description, score, file, kind]) {
      const asked = new URLSearchParams(location.search).get("q") ?? "";
      if (CODE.test(asked)) return score;
      if (asked !== query) [query, words] = [asked, stems(asked)];
      headings ??= readHeadings();
      const weight = WEIGHTS.find(([pages]) => pages.test(page))?.[1] ?? 0;
      if (kind === "object") return score + weight + OBJECT;
      if (kind !== "text") return score + weight;
      const best = Math.max(0, ...(headings[page] ?? []).map(share));
      return IN_HEADING * best + IN_TITLE * share(stems(title)) + weight;
    },
  };
})();
