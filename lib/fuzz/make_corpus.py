#!/usr/bin/env python3
"""Writes lib/fuzz/corpus/TARGET/*: one small good file of every kind that the readers take.

    lib/fuzz/make_corpus.py BIN     BIN: folder of built tools

Files named found-*, inputs that once broke a reader, are kept, and so are grown-*, which scripts/fuzz --keep has made of
the others.
"""
import base64
import io
import json
import os
import pathlib
import struct
import subprocess
import sys
import zipfile

# Files hold the command that made them, so every path is relative to the checkout.
BIN = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) == 2 else sys.exit(__doc__)
os.chdir(pathlib.Path(__file__).resolve().parent.parent.parent)
HERE, TESTDATA = pathlib.Path("lib/fuzz"), pathlib.Path("testdata")


def put(target, name, content):
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder / name


def tool(*arguments):
    return subprocess.run([BIN / arguments[0], *arguments[1:]], check=True, capture_output=True).stdout


def paints():
    text = (TESTDATA / "paints.paints.xml").read_text()
    small = ("</paint>".join(text.split("</paint>")[:2]) + "</paint>\n</paints>\n").encode()
    library = put("paint-xml", "library.xml", small)
    put("csv", "long.csv", tool("paint-convert", library, "--to", "csv"))
    put("csv", "wide.csv", "\n".join((TESTDATA / "paints-wide.csv").read_text().splitlines()[:3]) + "\n")
    put("csv", "german.csv", "\ufeffsample;geometry;L*;a*;b*\nx;45as15;41,5;-1,25;3\nx;45as45;30,1;0;-2,5\n")
    put("cxf", "library.cxf", tool("paint-convert", library, "--to", "cxf"))
    put("cgats", "library.txt", tool("paint-convert", library, "--to", "cgats"))
    put("paint-xml", "fitted.xml", subprocess.run(
        [BIN / "fit-paint", "-q", "-b", TESTDATA / "b5.basis.xml"], input=small, check=True,
        capture_output=True).stdout)
    put("paint-xml", "designed.xml", """<?xml version="1.0" encoding="UTF-8"?>
<paints xmlns="urn:goniochrome:paint:1" version="1">
<paint name="&#233;t&#xE9; &amp; &quot;red&quot;" class="pearl" code="1">
<measurement illuminant="A" observer="2" instrument="none"><lab geometry="45as-15" L="0.1" a="1e-17" b="-0"/>
<lab geometry="45as25az90" L="120" a="100" b="-100"/></measurement>
<gloss angle="20">82.1</gloss><gloss angle="60">0</gloss>
<appearance travel="63.5" residual_de00="0.1"><face L="80" a="1" b="2"/><flop L="20" a="-3" b="4"/></appearance>
<anisotropy alphaX="0.05" alphaY="0.3"/><colorMap href="x.exr" index="1.5"/><flakes diameter_um="30" coverage="0.5" spread_deg="0.5"/>
<note xmlns="urn:else"><![CDATA[<kept>]]></note><!-- said -->
</paint></paints>
""")


def workbooks():
    """Stored, so that a mutation of a byte is one of the XML; and packed."""
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    texts = ["Name", "Geometry", "L* (D65/10)", "a* (D65/10)", "b* (D65/10)", "red", "45as15", *map(str, range(400, 450, 10))]
    cell = '<c r="{}" t="s"><v>{}</v></c>'.format
    rows = "".join(cell(f"{'ABCDE'[i]}1", i) for i in range(5)) + "".join(cell(f"{'FGHIJ'[i]}1", 7 + i) for i in range(5))
    numbers = "".join(f'<c r="{"CDEFGHIJ"[i]}2"><v>{v}</v></c>' for i, v in enumerate((31.7, 14.7, -10.7, .1, .2, .3, .2, .1)))
    parts = {
        "xl/workbook.xml": f'<workbook {space} xmlns:r="r"><sheets><sheet name="Color" sheetId="1" r:id="a"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": '<Relationships><Relationship Id="a" Target="worksheets/s.xml"/></Relationships>',
        "xl/sharedStrings.xml": f"<sst {space}>" + "".join(f"<si><t>{text}</t></si>" for text in texts) + "</sst>",
        "xl/styles.xml": f'<styleSheet {space}><cellXfs><xf numFmtId="0"/><xf numFmtId="14"/></cellXfs></styleSheet>',
        "xl/worksheets/s.xml":
            f'<worksheet {space}><sheetData><row r="1">{rows}</row><row r="2">{cell("A2", 5)}{cell("B2", 6)}{numbers}</row>'
            f'<row r="3"><c r="A3" s="1"><v>45524.5</v></c><c r="B3" t="inlineStr"><is><t>45as45</t></is></c></row></sheetData>'
            f'<mergeCells><mergeCell ref="A2:A3"/></mergeCells></worksheet>'}
    for name, method in ("stored.xlsx", zipfile.ZIP_STORED), ("packed.xlsx", zipfile.ZIP_DEFLATED):
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w", method) as file:
            for part, content in parts.items():
                file.writestr(zipfile.ZipInfo(part), content, method)
        put("workbook", name, archive.getvalue())


def instruments():
    """The text formats of instruments' programs: a standard and a batch of 31 values."""
    values = [f"{5 + .5 * k:.3f}" for k in range(31)]
    put("qtx", "two.qtx", "".join(
        f"[{section} 0]\r\n{key}_NAME=r\xe9d {i}\r\n{key}_DATETIME=1029098162,\r\n{key}_REFLPOINTS=31,\r\n{key}_REFLINTERVAL=10,\r\n"
        f"{key}_REFLLOW=400\r\n{key}_VIEWING={viewing}\r\n{key}_R={', '.join(values)},\r\n{key}_CORD_ILLUM=D65/10 deg\r\n"
        f"{key}_X=9.9\r\n{key}_Y=6.9\r\n{key}_Z=5.5\r\n\r\n"
        for i, (section, key, viewing) in enumerate((("STANDARD_DATA", "STD", "45/0"), ("BATCH_DATA", "BAT", "%R SAV SCE UV Inc")))
    ).encode("cp1252"))
    info = "[FILE INFO]\nVERSION=2000\n%s\n[CUSTOMER]\nCUST=E\n[STANDARD]\n"
    put("mif", "two.mif", info % "ANGLE=MA" + "NAME=Silver\nDESC=d\n[MEASUREMENT]\nTIME=1\nINST=MA68\n"
        + "".join(f"ANGL={angle} {' '.join(values)}\n" for angle in (15, 45, 110, "Ex")) + "TAGS=x\n")
    put("xtf", "three.xtf", info % "ANGLES=3" + "STD=Gold`Original`731320`5`\nMEAS=8`0`1`\n"
        + "".join(f"REFL={k}`{'`'.join(values)}`\n" for k in range(3)) + "[SAMPLE]\nSMP=b`\nREFL=0`" + "`".join(values) + "`\n")
    columns = "    nm     0     10     20     30    40     50    60     70     80    90\r\n"
    rows = [values[k:k + 10] for k in range(0, 31, 10)]
    table = columns + "    300                                           0.000  0.000  0.000 0.000\r\n" + "".join(
        f"    {400 + 100 * i}    " + "".join(f"{v:<{6 + k % 2}}" for k, v in enumerate(row)) + "\r\n" for i, row in enumerate(rows))
    put("mtf", "two.mtf", "          TREEPOINT QTEX Statistics\r\n    Reference : ID          :S\r\n                Name        :r\r\n"
        f"                Status      :CM/Reflexion/SCI/N:1\r\n{table}    1/1   T-1 RED   0.30  0.68  -0.18  0.29  0.27  0.21\r\n{table}")
    head = ("##TITLE=r\n##JCAMP-DX=4.24\n##XUNITS=NANOMETERS\n##YUNITS=% REFLECTANCE\n##$GEOMETRY=45as15\n##FIRSTX=400\n##LASTX=700\n"
            "##NPOINTS=31\n##XFACTOR=1\n##YFACTOR=1\n##XYDATA=")
    put("jcamp", "plain.jdx", f"{head}(X++(Y..Y))\n400 {' '.join(values[:16])}\n560 {' '.join(values[16:])}\n##END=\n")
    put("jcamp", "packed.jdx", f"{head}(X++(Y..Y))\n400A0JY\n470A7JZ\n550B5JZ\n630C3JY\n##END=\n")
    put("jcamp", "pairs.jdx", f"{head}(XY..XY)\n" + "; ".join(f"{400 + 10 * k},{v}" for k, v in enumerate(values)) + "\n##END=\n")
    put("cxf", "two.cxf", '<CxF xmlns="http://colorexchangeformat.com/v2"><Palette PaletteName="p"><ColorSet><Color ColorName="r">'
        "<ColorSpaceCIELab><L>50</L><A>1</A><B>-2</B></ColorSpaceCIELab></Color><Color ColorName=\"s\">"
        f'<ReflectanceSpectrum StartWL="400" Increment="10">{" ".join(values)}</ReflectanceSpectrum></Color></ColorSet></Palette></CxF>')


def bases():
    put("basis-xml", "b5.xml", (TESTDATA / "b5.basis.xml").read_bytes())
    put("basis-xml", "small.xml", '<basis xmlns="urn:goniochrome:basis:1" name="b"><exponent>0.3</exponent>'
        '<exponent>70</exponent><mirror/></basis>\n')


def measured():
    rows = "".join(f"{i} 0 {o} {p} 0.3 0.2 0.1\n" for i in (0.2, 0.7) for o in (0.1, 0.6, 1.1) for p in (0, 1.5, 3.1))
    put("measured", "cornell.brdf", "# made\n# num wls\n3\n# wls\n400 550 700\n" + rows)
    table = [[nm * 1e-9, i, o, p, .1] for nm in (400, 550, 700) for i in (.2, .7) for o in (.1, .6) for p in (0, 1.5, 3.1)]
    put("measured", "table.xompt", json.dumps({"$schema": "x/OpenMATERIAL-3D", "metadata": {"name": "t"}, "brdf": {"lookupTable": table}}))
    grid = b"".join(struct.pack("<fff", 0.3, 0.2, 0.1 * k) for k in range(3 * 3 * 4))
    put("measured", "grid.mbsdf", b"NVIDIA ARC MBSDF V1\nMBSDF_DATA_REFLECTION=\n" + struct.pack("<III", 1, 3, 4) + grid)
    put("measured", "head.binary", struct.pack("<iii", 90, 90, 180) + struct.pack("<d", 0.5) * 16)
    theta = [0.0, 0.8, 1.5707963]
    fields = [("phi_i", [1], [0.0]), ("theta_i", [3], theta), ("sigma", [2, 2], [0.5] * 4), ("ndf", [2, 2], [2.0] * 4),
              ("vndf", [1, 3, 3, 3], [3.0] * 27), ("rgb", [1, 3, 3, 3, 3], [0.1 * (k % 7) for k in range(81)]),
              ("luminance", [1, 3, 3, 3], [0.2] * 27)]
    start = 12 + 2 + 4 + sum(2 + len(name) + 2 + 1 + 8 + 8 * len(shape) for name, shape, _ in fields)
    head, data = b"tensor_file\0\1\0" + struct.pack("<I", len(fields)), b""
    for name, shape, values in fields:
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), 10, start + len(data))
        head += struct.pack(f"<{len(shape)}Q", *shape)
        data += struct.pack(f"<{len(values)}f", *values)
    put("measured", "tensors.bsdf", head + data)


def environments():
    head = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n"
    sky = put("probe-hdr", "plain.hdr", head + bytes([128, 64, 32, 129]) * 128)
    put("probe-hdr", "runs.hdr", head + (bytes([2, 2, 0, 16]) + bytes([144, 128, 4, 9, 8, 7, 6, 140, 5, 144, 32, 144, 129])) * 8)
    out = HERE / "corpus" / "env-exr" / "sky.env.exr"
    tool("prefilter-envmap", "-q", sky, "--exponents", "6", "--size", "2", "-o", out)
    tool("prefilter-envmap", "-q", sky, "--exponents", "4", "--size", "2", "--layout", "mip", "-o", out.with_name("mip.env.exr"))


def buffers():
    tool("render-osmesa", "-q", "--engine", "cpu", "--mesh", TESTDATA / "box.obj", "--light", "0,20", "--size", "8x6", "--samples", "1",
         "--aov", "normal,aspecular,lambert,mask,part", "-o", put("buffers-exr", "box.exr", b""))


def meshes():
    put("obj", "cube.obj", "# made\nmtllib none.mtl\no Body\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n"
        "vt 0 0\nvn 0 0 1\nusemtl red\nf 1 2 3 4\nf 1/1/1 2/1/1 5/1/1\no Lid\ng top\nf -5//1 -4//1 -1//1\ns off\n")
    triangle = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
    uri = "data:application/octet-stream;base64," + base64.b64encode(triangle).decode()
    put("gltf", "triangle.gltf", json.dumps({
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [2, 2, 2], "children": [1]}, {"name": "Lid", "mesh": 0, "rotation": [0, 0, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}], "materials": [{"name": "red"}],
        "buffers": [{"byteLength": 42, "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]}))
    put("gltf", "doors.glb", (TESTDATA / "doors.glb").read_bytes())
    put("obj", "colors.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\nl 1 2\np 1\n")


    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 1)]
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 1)]
    lines = "".join("%g %g %g\n" % c for c in corners)
    put("off", "plain.off", f"OFF\n4 3 0\n{lines}" + "".join("3 %d %d %d\n" % f for f in faces))
    put("off", "colors.off", f"COFF\n# made\n4 1 0\n" + "".join("%g %g %g 255 0 0 255\n" % c for c in corners) + "4 0 1 2 3\n")
    head = ("ply\nformat %s 1.0\ncomment made\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 3\nproperty list uchar int vertex_indices\nend_header\n")
    put("ply", "plain.ply", head % "ascii" + lines + "".join("3 %d %d %d\n" % f for f in faces))
    for order, name in ("<", "little"), (">", "big"):
        data = b"".join(struct.pack(order + "fff", *c) for c in corners)
        data += b"".join(struct.pack(order + "Biii", 3, *f) for f in faces)
        put("ply", f"{name}.ply", (head % f"binary_{name}_endian").encode() + data)
    put("stl", "plain.stl", "solid made\n" + "".join(
        "facet normal 0 0 1\nouter loop\n" + "".join("vertex %g %g %g\n" % corners[i] for i in f) + "endloop\nendfacet\n"
        for f in faces) + "endsolid made\n")
    put("stl", "binary.stl", bytes(80) + struct.pack("<I", len(faces)) + b"".join(
        struct.pack("<12fH", 0, 0, 1, *(v for i in f for v in corners[i]), 0) for f in faces))


def pictures():
    for target, name, *options in [
            ("image-png", "rgb.png", "-d", "uint8"), ("image-png", "deep.png", "-d", "uint16"),
            ("image-jpeg", "plain.jpg"),
            ("image-tiff", "plain.tif", "-d", "uint8", "--compression", "none"),
            ("image-tiff", "lzw.tif", "-d", "uint16", "--compression", "lzw"),
            ("image-tiff", "float.tif", "-d", "float", "--compression", "zip"),
            ("image-tiff", "tiles.tif", "-d", "uint8", "--tile", "16", "16"),
            ("image-other", "six.ppm", "-d", "uint8")]:
        path = put(target, name, b"")
        subprocess.run(["oiiotool", "--pattern", "fill:topleft=1,0,0:bottomright=0,.2,1", "9x5", "3", *options, "-o", path],
                       check=True)
    put("image-other", "three.ppm", "P3\n# made\n2 1\n255\n1 2 3 255 0 9\n")
    put("image-other", "one.pbm", "P1\n3 2\n1 0 1\n0 1 0\n")
    put("image-other", "floats.pfm", b"PF\n1 2\n-1\n" + struct.pack("<6f", 1, .5, 1, 1, .5, 1))
    put("image-other", "unwanted.iff", b"FOR4\0\0\0\x40CIMGTBHD\0\0\0\x20" + bytes(56))
    channels = "diffuse.R,diffuse.G,diffuse.B,lobe0.R,lobe0.G,lobe0.B,lobe0.x,lobe0.y,lobe0.z,lobe0.n"
    subprocess.run(["oiiotool", "--pattern", "constant:color=.1,.2,.3,.1,.1,.1,-1,-1,1,20", "4x4", "10", "-d", "half",
                    "--chnames", channels, "-o", put("sbrdf-exr", "plain.sbrdf.exr", b"")], check=True)


def operators():
    plain = [[[1.0 if c == d == e else 0.0 for e in range(3)] for d in range(3)] for c in range(3)]
    put("operator-json", "plain.json", json.dumps({"name": "plain", "k": plain}))


paints(), workbooks(), instruments(), bases(), measured(), environments(), buffers(), meshes(), pictures(), operators()
print(sum(f.stat().st_size for f in HERE.glob("corpus/*/*")), "bytes", file=sys.stderr)
