// Orders what a search finds. Everyday words lead to the pages that explain, first to those with the
// words in a heading, and to the section below it; what looks like a name in code leads to where it is
// described, as Sphinx has it.

var Scorer = (() => {
  // Of a name in code: an underscore, a dot, or a capital inside.
  const CODE = /[_.(]|\w[A-Z]/;
  // What is made of the code says little to somebody who does not know its names.
  const WEIGHTS = [
    [/^reference\/generated\//, -12],
    [/^reference\//, -3],
    [/^(troubleshooting)$/, 5],
    [/^cockpit$/, 6],
    [/^(concepts|effects|stability|install|compose)$/, 3],
    [/^tutorials\//, -1],
  ];
  // What people call it who do not know what pages and sections call it.
  const ABOUT = {
    "accuracy": "how exact error budget",
    "reference/api#what-is-stable-and-for-how-long": "version compatible breaking deprecated",
    "architecture": "source folder layout contribute",
    "cockpit#without-a-device": "no device simulate device browser",
    "comparison": "alternative versus limits",
    "compose": "own plant robot MultibodyPlant",
    "concepts": "symbol frame notation force on the hand",
    "concepts#units": "damping stiffness unit",
    "connect-a-device": "bridge own device arm motor",
    "device-protocol#write-a-driver": "bridge own device vendor SDK motor",
    "device-twin": "encoder noise",
    "effects": "friction shading texture braking weight gravity",
    "gradients": "AutoDiff Jacobian linearize",
    "install": "pip wheel macOS Windows Python version",
    "verification/contact-laws": "fall through thin wall plate tunnel",
    "paper": "citing cite reference author bibtex",
    "record-replay": "record log a run CSV",
    "stability": "network delay latency vibration passive",
    "troubleshooting#buzzing": "vibration tremor hum noise",
    "troubleshooting#does-not-fit": "peg hole tolerance clearance",
    "troubleshooting#meshes": "mesh in inch millimeter unit scale",
    "troubleshooting#tunnelling": "tool sink fall through wall",
    "troubleshooting#weak-force": "weak soft force limit",
    "troubleshooting#late-ticks": "slow overrun load",
  };
  const IN_HEADING = 12, IN_TITLE = 5, OBJECT = -10;
  let query = "";
  let words = [];
  let sections = null;

  function stems(text) {
    const stemmer = new Stemmer();
    return splitQuery(text.toLowerCase()).filter(word => !stopwords.has(word)).map(word => stemmer.stemWord(word));
  }

  /** The sections of each page, by its name: heading, id, and the stems of all that they are called. */
  function readSections() {
    const {alltitles, docnames} = Search._index;
    const found = {};
    for (const [heading, places] of Object.entries(alltitles))
      for (const [file, id] of places)
        (found[docnames[file]] ??= []).push({heading, id, called: [stems(heading)]});
    for (const [place, text] of Object.entries(ABOUT)) {
      const [page, id = null] = place.split("#");
      found[page]?.find(section => section.id === id)?.called.push(stems(text));
    }
    return found;
  }

  /** The share of the words that is in a text. */
  function share(text) {
    return words.filter(word => text.includes(word)).length / Math.max(words.length, 1);
  }

  const shareOf = section => Math.max(...section.called.map(share));

  return {
    objNameMatch: 11, objPartialMatch: 6, objPrio: {0: 15, 1: 5, 2: -5}, objPrioDefault: 0,
    title: 15, partialTitle: 7, term: 5, partialTerm: 2,

    /** A result's score; one that is all about a section is made to lead there. */
    score(result) {
      const [page, title, , , score, , kind] = result;
      const asked = new URLSearchParams(location.search).get("q") ?? "";
      if (CODE.test(asked)) return score;
      if (asked !== query) [query, words] = [asked, stems(asked)];
      sections ??= readSections();
      const weight = WEIGHTS.find(([pages]) => pages.test(page))?.[1] ?? 0;
      if (kind === "object") return score + weight + OBJECT;
      if (kind !== "text") return score + weight;
      const [best] = [...sections[page] ?? []].sort((a, b) => shareOf(b) - shareOf(a));
      const inHeading = best ? shareOf(best) : 0;
      if (inHeading === 1 && best.id) [result[1], result[2]] = [`${title} > ${best.heading}`, "#" + best.id];
      return IN_HEADING * inHeading + IN_TITLE * share(stems(title)) + weight;
    },
  };
})();
