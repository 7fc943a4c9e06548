#!/usr/bin/env bats
# scripts/paint-book from outside: what the page has, and whether it is consistent. No browser is used here.

book() {
  "$BATS_TEST_DIRNAME/../paint-book" "$@"
}

setup_file() {
  cd "$BATS_FILE_TMPDIR"
  cat >small.paints.xml <<'XML'
<paints xmlns="urn:goniochrome:paint:1" version="1">
  <paint name="gray" class="solid"><measurement illuminant="D65" observer="10">
    <lab geometry="45as15" L="50" a="0" b="0"/><lab geometry="45as45" L="50" a="0" b="0"/><lab geometry="45as110" L="50" a="0" b="0"/>
  </measurement></paint>
  <paint name="red" class="solid" code="R1"><measurement illuminant="D65" observer="10">
    <lab geometry="45as15" L="43" a="57" b="37"/><lab geometry="45as45" L="42" a="58" b="38"/><lab geometry="45as110" L="42" a="59" b="39"/>
  </measurement><gloss angle="60">90</gloss></paint>
  <paint name="blue &lt;/script&gt; &quot;x&quot; &amp; {{title}}" class="metallic"><measurement illuminant="D65" observer="10">
    <lab geometry="45as-15" L="61" a="-14" b="-53"/><lab geometry="45as15" L="58" a="-13" b="-55"/>
    <lab geometry="45as45" L="29" a="4" b="-53"/><lab geometry="45as110" L="12" a="18" b="-39"/>
  </measurement><gloss angle="60">92</gloss></paint>
  <paint name="designed" class="pearl"><appearance travel="80"><face L="80" a="-2" b="60"/><flop L="40" a="5" b="30"/></appearance></paint>
</paints>
XML
  prefilter-envmap "$TESTDATA/studio.exr" --basis "$TESTDATA/b5.basis.xml" --size 16 --quiet -o small.env.exr
  book small.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --title 'A & B' -o small.html
}

setup() {
  cd "$BATS_FILE_TMPDIR"
}

@test "the page is consistent: ids, links, cards, sliders and data" {
  /usr/bin/python3 - small.html <<'PY'
import base64, html.parser, json, sys

class Reader(html.parser.HTMLParser):
    VOID = {"meta", "input", "img", "link", "br"}

    def __init__(self):
        super().__init__()
        self.open, self.tags, self.texts = [], [], {}

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append((tag, attributes))
        if tag not in self.VOID:
            self.open.append((tag, attributes.get("id")))

    def handle_startendtag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        name, _ = self.open.pop()
        assert name == tag, f"</{tag}> closes <{name}>"

    def handle_data(self, data):
        if self.open:
            self.texts.setdefault(self.open[-1][1], []).append(data)

page = Reader()
page.feed(open(sys.argv[1], encoding="utf-8").read())
page.close()
assert not page.open, page.open
tags = page.tags
ids = [a["id"] for _, a in tags if "id" in a and a["id"] != "card-name"]
assert len(ids) == len(set(ids)), "an id stands twice"

# Nothing is fetched, since every address is inside the page.
for tag, a in tags:
    for key in ("src", "href", "action", "poster", "data"):
        value = a.get(key)
        assert value is None or value.startswith(("#", "data:image/png;base64,")), (tag, key, value[:60])
        if value and value.startswith("#"):
            assert value[1:] in ids, value
for tag, a in tags:
    for key in ("aria-labelledby", "for"):
        assert a.get(key) is None or a[key] in ids + ["card-name"], a

paints = json.loads("".join(page.texts["data"]))
assert [p["name"] for p in paints] == ["gray", "red", 'blue </script> "x" & {{title}}', "designed"]
tiles = [int(a["data-paint"]) for _, a in tags if "data-paint" in a]
assert sorted(tiles) == [0, 1, 2, 3]
for i in tiles:
    assert f"card-{i}" in ids
for _, a in tags:
    if a.get("src", "").startswith("data:image"):
        png = base64.b64decode(a["src"].split(",")[1])
        assert png[:8] == b"\x89PNG\r\n\x1a\n" and png[16:24] == bytes([0, 0, 0, 96, 0, 0, 0, 64])

# The page has what the filter reads.
indices = [a["data-index"] for _, a in tags if "data-index" in a]
assert indices == ["flop_index", "chroma_index", "hue_shift_index"]
classes = [a["value"] for _, a in tags if a.get("type") == "checkbox"]
assert classes == ["solid", "metallic", "pearl"]
sliders = [a for _, a in tags if a.get("type") == "range"]
assert len(sliders) == 6
for index, low, high in zip(indices, sliders[::2], sliders[1::2]):
    assert low["value"] == low["min"] and high["value"] == high["max"] and low["min"] == high["min"]
    for p in paints:
        assert p["class"] in classes
        assert p[index] is None or float(low["min"]) <= p[index] <= float(high["max"]), (index, p[index])
    assert all(a["aria-label"] for a in (low, high))
assert paints[0]["hue_shift_index"] is None, "a gray has no hue"
assert paints[0]["flop_index"] == 0
assert abs(paints[2]["flop_index"] - 2.69 * 46 ** 1.11 / 29 ** 0.86) < 1e-6

# Every paint can be downloaded in three formats.
for p in paints:
    assert [f["name"].rsplit(".", 1)[1] for f in p["files"]] == ["xml", "csv", "cxf"]
    assert all("/" not in f["name"] and "<" not in f["name"] and f["text"] for f in p["files"])

# Gray and red stand among the solids, blue and yellow among the effect colors.
heads = [a["id"] for tag, a in tags if tag in ("h2", "h3") and "id" in a and a["id"] != "card-name"]
assert heads == ["solids", "solids-red", "solids-medium", "effects", "effects-yellow", "effects-blue"], heads
PY
}

@test "texts from the library are text in the page" {
  grep -qF '<title>A &amp; B</title>' small.html
  grep -qF 'blue &lt;/script&gt; &quot;x&quot; &amp; {{title}}' small.html
  [ "$(grep -c '</script>' small.html)" -eq 2 ]
}

@test "with --studio each card links its paint in that page, by a name that is no markup" {
  mkdir -p other
  ! grep -q 'href="[^"]*#paint=' small.html || false
  book small.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --studio 'my studio.html' -o other/linked.html
  [ "$(grep -o 'href="../my%20studio.html#paint=[^"]*"' other/linked.html | wc -l)" -eq 4 ]
  grep -qF 'href="../my%20studio.html#paint=blue%20%3C%2Fscript%3E%20%22x%22%20%26%20%7B%7Btitle%7D%7D"' other/linked.html
}

@test "names and titles in bytes outside UTF-8 give a page in UTF-8" {
  library=$(printf 'caf\351.paints.xml')
  cp small.paints.xml "$library"
  book "$library" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --title "$(printf 'caf\351 <b>')" -o bad.html
  iconv -f UTF-8 -t UTF-8 bad.html >/dev/null
  grep -q '<title>caf.* &lt;b&gt;</title>' bad.html
}

@test "the downloads read back with the paint's numbers" {
  /usr/bin/python3 - small.html <<'PY'
import json, re, sys
page = open(sys.argv[1], encoding="utf-8").read()
for paint in json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1]):
    for f in paint["files"]:
        open("taken." + f["name"].rsplit(".", 1)[1], "w", encoding="utf-8").write(f["text"])
    if paint["name"] == "red":
        break
PY
  mv taken.xml taken.paints.xml
  for file in taken.paints.xml taken.csv taken.cxf; do
    paint-convert "$file" --to csv -o - | grep -qE '^red,45as45,D65,10,42,58,38(,row)?$'
  done
}

@test "lobes are fitted anew, or kept with --fitted" {
  paint-convert -q small.paints.xml -o - | fit-paint -q --basis "$TESTDATA/b5.basis.xml" --method l2 - -o fitted.paints.xml
  book fitted.paints.xml --fitted --env small.env.exr --size 96x64 -o kept.html
  book fitted.paints.xml --basis "$TESTDATA/b5.basis.xml" --env small.env.exr --size 96x64 -o anew.html
  grep -oE 'method=."l[12]' kept.html | sort -u >kept
  grep -oE 'method=."l[12]' anew.html | sort -u >anew
  [ "$(cat kept anew)" = $'method=\\"l2\nmethod=\\"l1' ]
}

@test "the filter is one function in the page, and the page loads no other script" {
  grep -qF 'function matches(paint, wanted)' small.html
  grep -qF 'whole || (paint[index] !== null && paint[index] >= low && paint[index] <= high)' small.html
  ! grep -qE 'https?://[^u]*\.(js|css)|@import|fetch\(|XMLHttpRequest' small.html || false
}

@test "a paint without gloss is drawn matt or with the gloss assumed, and its card says so" {
  [ "$(grep -c 'Note: no gloss reading, drawn matt' small.html)" -ge 1 ]
  book "$BATS_FILE_TMPDIR/small.paints.xml" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --gloss 85 --quiet -o coated.html
  grep -q 'Note: no gloss reading, drawn with 85 units' coated.html
}

@test "a missing library, mesh or light is named, and no part of a book is left" {
  run book missing.paints.xml -o none.html
  [ "$status" -eq 3 ]
  [[ $output == *missing.paints.xml* ]]
  run book small.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --mesh missing.obj --size 96x64 -o none.html
  [ "$status" -eq 3 ]
  [[ $output == *missing.obj* ]]
  run book small.paints.xml --env missing.exr -o none.html
  [ "$status" -eq 3 ]
  [[ $output == *missing.exr* ]]
  run book small.paints.xml --env small.env.exr -o nowhere/none.html
  [ "$status" -eq 3 ]
  [[ $output == *"nowhere: there is no such folder"* ]]
  [ -z "$(find . -name 'none.html*')" ]
}

@test "usage errors" {
  run book small.paints.xml
  [ "$status" -eq 2 ]
  run book small.paints.xml --size big -o none.html
  [ "$status" -eq 2 ]
  [[ $output == *"give width x height in pixels"* ]]
  run book small.paints.xml --jobs 0 -o none.html
  [ "$status" -eq 2 ]
  for wrong in 0 -1 two 1.5; do
    run book small.paints.xml --page-paints="$wrong" -o none.html
    [ "$status" -eq 2 ]
    [[ "$output" == *'--page-paints: "'"$wrong"'": give a whole number of 1 or more'* ]]
  done
  run book small.paints.xml -o none.html --page-paints
  [ "$status" -eq 2 ]
  [[ "$output" == *"--page-paints"* ]]
  run book small.paints.xml --gloss 101 -o none.html
  [ "$status" -eq 2 ]
  [[ $output == *"give gloss units from 0 to 100"* ]]
  run book small.paints.xml --bin /nowhere -o none.html
  [ "$status" -eq 3 ]
  [[ $output == *"paint-convert is not in /nowhere"* ]]
}

@test "the message of a tool reaches the user" {
  printf '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="p"><gloss angle="60">5</gloss></paint></paints>' >colorless.paints.xml
  run book colorless.paints.xml --env small.env.exr -o none.html
  [ "$status" -eq 3 ]
  [[ $output == "paint-book: "*p* ]]
  [ ! -e none.html ]
}

@test "a book goes to standard output, through a pipe and into a device, and replaces none of them" {
  local few="$BATS_TEST_TMPDIR/one.paints.xml"
  printf '%s' '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="p"><measurement illuminant="D65" observer="10">' \
    '<lab geometry="45as15" L="50" a="0" b="0"/><lab geometry="45as45" L="40" a="0" b="0"/><lab geometry="45as110" L="30" a="0" b="0"/>' \
    '</measurement></paint></paints>' >"$few"
  book "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o - >printed.html
  head -c 100 printed.html | grep -qi '<!doctype html'
  mkfifo pipe.html
  cat pipe.html >piped.html &
  book "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o pipe.html
  wait $!
  [ -p pipe.html ]
  [ "$(wc -c <piped.html)" -gt 10000 ]
  book "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o /dev/null
  [ -c /dev/null ]
  # A link and a mode stay.
  echo old >real.html
  chmod 600 real.html
  ln -s real.html link.html
  book "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o link.html
  [ -L link.html ]
  [ "$(stat -c %a real.html)" = 600 ]
  [ "$(wc -c <real.html)" -gt 10000 ]
  # With standard output closed, to print is an error, and the book is whole.
  book "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 -o closed.html >&- 2>&-
  tail -c 20 closed.html | grep -q '</html>'
  run bash -c '"$@" >&-' closed "$BATS_TEST_DIRNAME/../paint-book" "$few" --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o -
  [ "$status" -ne 0 ]
}

@test "chips are faceted: a picture of a paint without gloss shows a flat color for each facet" {
  /usr/bin/python3 - <<PY
import sys
sys.path.insert(0, "$BATS_TEST_DIRNAME/..")
from paint_book import chip

lines = chip.chip_obj().splitlines()
normals = [tuple(map(float, line.split()[1:])) for line in lines if line.startswith("vn")]
faces = [line for line in lines if line.startswith("f ")]
assert len(faces) == len(normals) == 1 + chip.SIDES * (len(chip.TILTS_DEG) - 1)
assert normals[0] == (0, 0, 1)
# Facets face the camera, and each ring has its own tilt.
assert all(n[2] > 0 and abs(sum(x * x for x in n) - 1) < 1e-6 for n in normals), normals
assert len({round(n[2], 6) for n in normals}) == len(chip.TILTS_DEG)
PY
  book small.paints.xml --chips --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x96 -o chips.html
  grep -q "on faceted chip under" chips.html
  ! cmp -s chips.html small.html || false
}

@test "--beside: pictures and cards lie in a folder, with the same texts, and a paint without a picture is named" {
  book small.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --beside -o beside.html
  [ -s beside.files/tiles-0001.png ]
  /usr/bin/python3 - small.html beside.html <<'PY'
import json, re, sys
inside, beside = (open(name, encoding="utf-8").read() for name in sys.argv[1:])
def rows(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
facts = json.loads(re.search(r'id="beside">(.*?)</script>', beside, re.S)[1])
assert facts["folder"] == "beside.files" and facts["tile"] == [96, 64], facts
assert facts["left"] + facts["columns"] * facts["right"] == facts["width"], "sheets as wide as their tiles"
assert facts["rows"] * facts["down"] + facts["top"] == facts["height"]
script = open("beside.files/cards-0001.js", encoding="utf-8").read()
cards = json.loads(script[script.index(",") + 1:script.rindex(")")])
assert [row["name"] for row in rows(inside)] == [row["name"] for row in rows(beside)]
def untimed(text):
    return re.sub(r"\d{4}-\d\d-\d\dT[\d:]+Z", "", text)
for one, other in zip(rows(inside), cards):
    assert [(f["name"], untimed(f["text"])) for f in one["files"]] == [(f["name"], untimed(f["text"])) for f in other["files"]], one["name"]
listed = sorted(index for order in re.findall(r'data-paints="(\[[^"]*\])"', beside) for index in json.loads(order))
assert listed == list(range(4)), listed
assert "data:image" not in beside
PY
  paint-convert -q small.paints.xml -o - | fit-paint -q --basis "$TESTDATA/b5.basis.xml" --method l2 - -o fitted.paints.xml
  # One paint has a lobe that the environment lacks.
  /usr/bin/python3 -c 'import re; s = open("fitted.paints.xml").read(); at = s.index("<lobes"); print(s[:at] + re.sub(r"exponent=\"[0-9.]+\"", "exponent=\"77\"", s[at:], count=1), end="")' >bad.paints.xml
  run book bad.paints.xml --fitted --env small.env.exr --size 96x64 --beside -o bad.html
  [ "$status" -eq 1 ]
  [[ "$output" =~ "paint-book: no picture: the paint \"red\"" ]]
  [ -s bad.html ]
  run book small.paints.xml --beside -o -
  [ "$status" -eq 2 ]
}

@test "--page-paints: pages in the order of class and hue, linked with each other and with an index of all paints" {
  book small.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --page-paints 3 --title 'A & B' --quiet -o many.html
  /usr/bin/python3 - <<'PY'
import json, re
def text(name):
    return open(name, encoding="utf-8").read()
def data(page):
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.S)[1])
index, single = data(text("many.html")), data(text("small.html"))
assert [one["page"] for one in index] == ["many-001.html", "many-002.html"], index
assert [len(one["paints"]) for one in index] == [2, 2]
listed = [paint[:3] for one in index for paint in one["paints"]]
assert sorted(listed) == sorted([row["name"], row["code"], row["class"]] for row in single), listed
order = [int(i) for i in re.findall(r'<li data-paint="(\d+)"', text("small.html"))]
assert [one[0] for one in listed] == [single[i]["name"] for i in order], "the order of the book of one page"
assert all(re.fullmatch("(#[0-9a-f]{6}){3}", paint[3]) for one in index for paint in one["paints"])
for number, one in enumerate(index, 1):
    page = text(one["page"])
    assert [row["name"] for row in data(page)] == [paint[0] for paint in one["paints"]]
    assert f'<a href="many.html">Index, page {number} of 2</a>' in page
    assert ("many-002.html" in page) == (number == 1) and ("many-001.html" in page) == (number == 2), "the neighbors"
    assert f"many-{number:03}.files" in page
assert "{{" not in text("many.html").replace("{{title}}", "", 1) and "A &amp; B" in text("many.html")
assert text("many.html").count("<script") == 2
PY
  [ -s many-001.files/tiles-0001.png ]
  [ -s many-002.files/cards-0001.js ]
}

# The tiles of a page of few paints, one to a line: heading, name or class, command.
tiles_of() {
  /usr/bin/python3 - "$1" <<'PY'
import html, re, sys
page = open(sys.argv[1], encoding="utf-8").read()
assert "{{" not in re.sub(r"<main.*</main>", "", page, flags=re.S)
assert not re.search(r'(src|href)="(?!data:)', page), "the page needs no other file"
for tile in re.findall(r"<li.*?</li>", page, re.S):
    heading = re.search(r"<h3>(.*?)<small>(.*?)</small>", tile)
    print(*(html.unescape(found) for found in (heading[1], heading[2], re.search(r"<code>(.*?)</code>", tile)[1])), sep="|")
PY
}

@test "--variations: nine tiles around the paint as it was, each with a command that goes on from it" {
  paint-edit -q "$TESTDATA/paints.paints.xml#candy_red" --variations face --step 7 |
    book --variations - --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --quiet -o sheet.html
  tiles_of sheet.html >tiles
  [ "$(cut -d'|' -f1 tiles | paste -sd,)" = "Face lighter,Face darker,Face red,Face yellow,As it was,Face green,Face cyan,Face blue,Face magenta" ]
  [ "$(sed -n 5p tiles | cut -d'|' -f2)" = candy_red ]
  [ "$(grep -c '<li class=middle>' sheet.html)" -eq 1 ]
  sed -n 1p tiles | grep -qF 'paint-edit candy_red.face-lighter.paints.xml --variations face --step 7 | paint-book --variations - --env small.env.exr'
  sed -n 1p tiles | grep -qF -- '--size 96x64 -o candy_red.face-lighter.html'

  # The file of a tile and its command lead on.
  /usr/bin/python3 - sheet.html <<'PY'
import re, sys, urllib.parse
page = open(sys.argv[1], encoding="utf-8").read()
for name, address in ((n, a) for a, n in re.findall(r'href="data:application/xml;charset=utf-8,([^"]*)" download="([^"]*)"', page)):
    open(name, "w", encoding="utf-8").write(urllib.parse.unquote(address))
PY
  paint-book() { book "$@"; }
  eval "$(sed -n 1p tiles | cut -d'|' -f3-)"
  tiles_of candy_red.face-lighter.html | sed -n 5p | grep -qF 'As it was|candy_red.face-lighter|'

  # The pictures are those of the paints: the middle as the paint itself.
  paint-convert -q "$TESTDATA/paints.paints.xml#candy_red" -o one.paints.xml
  book one.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 96x64 --quiet -o one.html
  /usr/bin/python3 - sheet.html one.html <<'PY'
import base64, re, struct, sys
def pixels(png, at=8):
    """The compressed pixels, without the notes of the file, which name the run."""
    size, kind = struct.unpack(">I4s", png[at:at + 8])
    rest = pixels(png, at + 12 + size) if kind != b"IEND" else b""
    return (png[at + 8:at + 8 + size] if kind == b"IDAT" else b"") + rest
sheet, one = ([pixels(base64.b64decode(text)) for text in re.findall(r'src="data:image/png;base64,([^"]*)"', open(name).read())]
              for name in sys.argv[1:])
assert len(sheet) == 9 and sheet[4] == one[0]
assert len(set(sheet)) == 9, "no two variations look the same"
PY
}

@test "--variations: of a file with other paints, by name; two paints make two sheets" {
  cp "$TESTDATA/paints.paints.xml" all.paints.xml
  paint-edit -q all.paints.xml --only candy_red --variations travel --step 4 -o some.paints.xml
  book --variations some.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o travel.html
  tiles_of travel.html >tiles
  [ "$(cut -d'|' -f1 tiles | paste -sd,)" = "Travel -16,Travel -12,Travel -8,Travel -4,As it was,Travel +4,Travel +8,Travel +12,Travel +16" ]
  sed -n 9p tiles | grep -qF "paint-edit 'some.paints.xml#candy_red.travel+16' --variations travel --step 4 |"
  # A name that only looks like one of a variation is that of another paint, which is left out and told.
  sed 's/name="candy_red.travel+16"/name="candy_red.travel-e"/' some.paints.xml >odd.paints.xml
  run book --variations odd.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 -o odd.html
  [ "$status" -eq 0 ]
  [[ "$output" =~ warning:\ ([0-9]+)\ paints\ left\ out ]]
  [ "${BASH_REMATCH[1]}" -eq "$(($(grep -c '<paint ' odd.paints.xml) - 8))" ]
  ! grep -qF 'candy_red.travel-e' odd.html || false
  [ "$(tiles_of odd.html | wc -l)" -eq 8 ]
  sed 's/name="candy_red[.]travel\([^"]*\)"/name="candy_red.layer\1"/' some.paints.xml >layers.paints.xml
  run book --variations layers.paints.xml -o layers.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ "there are no variations in it" ]]
  paint-edit -q 'all.paints.xml#candy_red,jet_black' --variations gloss --step 3 |
    book --variations - --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 --quiet -o gloss.html
  [ "$(grep -c '<section' gloss.html)" -eq 2 ]
  run book --variations all.paints.xml -o none.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ "there are no variations in it: paint-edit --variations makes them" ]]
  [ ! -e none.html ]
}

@test "--palette: flat chips in the order of the library, in a border of their gloss" {
  book --palette small.paints.xml --quiet -o palette.html
  tiles_of palette.html | cut -d'|' -f2 >classes
  [ "$(paste -sd, classes)" = "solid,code R1, solid,metallic,pearl" ]
  grep -qF '<h3>blue &lt;/script&gt; &quot;x&quot; &amp; {{title}}<small>' palette.html
  [ "$(grep -o 'border:12px [a-z]* #[0-9a-f]*' palette.html | paste -sd,)" = \
    "border:12px dashed #808080,border:12px solid #e5e5e5,border:12px solid #ebebeb,border:12px dashed #808080" ]
  [ "$(grep -o 'linear-gradient([^;]*) padding-box;border:12px' palette.html | wc -l)" -eq 4 ]
  ! grep -q '<img' palette.html || false
  run book --palette --variations small.paints.xml -o x.html
  [ "$status" -eq 2 ]
  run book --palette small.paints.xml --beside -o x.html
  [ "$status" -eq 2 ]
}

@test "a paint without a color is left out and named, and the book has the others" {
  sed 's|<paint name="red"|<paint name="bare" class="solid"/>&|' small.paints.xml >bare.paints.xml
  run book bare.paints.xml --env small.env.exr --basis "$TESTDATA/b5.basis.xml" --size 32x24 -o bare.html
  [ "$status" -eq 1 ]
  [[ "$output" =~ 'bare.html: 4 paints' ]]
  [[ "$output" =~ 'paint-book: left out: paint "bare" has neither measured rows nor an appearance' ]]
  /usr/bin/python3 - <<'PY'
import json, re
def names(page):
    return [paint["name"] for paint in json.loads(re.search(r'id="data">(.*?)</script>', open(page, encoding="utf-8").read(), re.S)[1])]
assert names("bare.html") == names("small.html"), names("bare.html")
PY
  run book --palette bare.paints.xml -o bare-palette.html
  [ "$status" -eq 1 ]
  [[ "$output" =~ 'left out: paint "bare"' ]]
  # Where no paint is left there is no book.
  printf '%s\n' '<paints xmlns="urn:goniochrome:paint:1" version="1"><paint name="bare" class="solid"/></paints>' >none.paints.xml
  run book --palette none.paints.xml -o bare-none.html
  [ "$status" -eq 3 ]
  [[ "$output" =~ 'paint "bare" has neither measured rows nor an appearance' ]]
  [ ! -e bare-none.html ]
}
