#!/usr/bin/env bats
# scripts/accuracy-report from outside: its options, its page and its readings.

bats_require_minimum_version 1.5.0

report() {
  "$BATS_TEST_DIRNAME/../accuracy-report" "$@"
}

setup() {
  cd "$BATS_TEST_TMPDIR" || exit 1
}

# refused STATUS MESSAGE OPTION...: the options are refused with this message, and nothing is written.
refused() {
  local wanted=$1 message=$2
  shift 2
  run --separate-stderr report basis --quick -o none "$@"
  [ "$status" -eq "$wanted" ] || { echo "status $status: $stderr"; return 1; }
  [[ "$stderr" == *"$message"* ]] || { echo "$stderr"; return 1; }
  [ ! -e none ]
}

@test "options are checked" {
  refused 2 'there is no study bases: choose of paths' bases
  refused 2 'expected one argument' --bin
  refused 3 'nowhere: the tools are not there' --bin nowhere
  for option in --paints --probe --mesh; do
    refused 2 'expected one argument' $option
    refused 3 'none.xml: there is no such file' $option none.xml
  done
  refused 3 'none.xml: there is no such file' --paints 'none.xml#signal_red'
  refused 3 'none: there is no such file' --paints "$BATS_TEST_DIRNAME/../../testdata/paints.paints.xml#signal_red" --probe none
  refused 2 'expected one argument' --target-de00
  refused 2 'invalid float' --target-de00 small
  refused 2 'is 0: give a color difference above 0' --target-de00 0
  refused 2 '--scene goes with --target-de00' --scene signal_red
  refused 2 'expected one argument' --output
  echo kept >file
  run --separate-stderr report basis --quick -o file
  [ "$status" -eq 3 ]
  [[ "$stderr" == *'file: is a file: --output names the folder of the page'* ]]
  [ "$(cat file)" = kept ]
}

@test "verdicts, numbers and pictures" {
  /usr/bin/python3 "$BATS_TEST_DIRNAME/accuracy_test.py"
}

@test "two studies make a consistent page with the time of every run" {
  run report fit basis --quick --bin "$(dirname "$(command -v draw-plot)")" -o out
  echo "$output"
  [ "$status" -eq 0 ]
  /usr/bin/python3 - out <<'PY'
import csv, html.parser, pathlib, sys

out = pathlib.Path(sys.argv[1])

class Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.ids, self.links, self.words = [], set(), [], []

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.ids.add(attributes.get("id"))
        self.links += [value for key, value in attributes.items() if key in ("href", "src", "xlink:href")]
        assert tag not in ("script", "img", "link", "iframe"), tag
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        pass

    def handle_endtag(self, tag):
        assert self.open and self.open.pop() == tag, tag

    def handle_data(self, data):
        self.words.append(data)

page = Reader()
text = (out / "index.html").read_text()
page.feed(text)
page.close()
assert not page.open, page.open
for link in page.links:
    assert link == "readings.csv" or link[1:] in page.ids, link
assert "url(" not in text and "@import" not in text
assert {"Fitting", "Choosing a basis"} <= {w.strip() for w in page.words}

rows = list(csv.DictReader((out / "readings.csv").open()))
assert {row["study"] for row in rows} == {"Fitting", "Choosing a basis"}
for row in rows:
    times = [float(s) for s in row["all_times_s"].split()]
    assert times and abs(min(times) / float(row["time_s"]) - 1) < 1e-4, row
assert sum(int(row["default"]) for row in rows if row["figure"] == "basis-starts") == 1
for name in {row["figure"] for row in rows}:
    assert (out / f"{name}.svg").read_text() in text, name
PY
}

@test "the projection factor softens the rim of a sphere, whatever the treatment of the critical angle" {
  run report isolines --quick --bin "$(dirname "$(command -v draw-plot)")" -o out
  echo "$output"
  [ "$status" -eq 0 ]
  /usr/bin/python3 - out <<'PY'
import pathlib, re, sys

page = (pathlib.Path(sys.argv[1]) / "index.html").read_text()
rows = [re.findall(r"<td[^>]*>([^<]*)", row) for row in re.findall(r"<tr>(.*?)</tr>", page, re.S)]
rows = [row for row in rows if len(row) == 7]
assert [row[2] for row in rows] == ["clip", "slide", "index"], rows
for row in rows:
    without, factor, mean = map(float, row[3:6])
    assert without > 15 and factor < without / 4 and (row[2] == "clip") == (mean == 0), row
PY
}
