"""doors.glb: a small closet in glTF 2.0, which shows nodes, instances and materials.

It is a box in the material Steel and two doors, which are one mesh of a Panel and a Pane, of which the second is a mirror image
of the first; both are turned open. The node of the closet lifts it by 1 m, and its parts are Closet, Left.Panel, Left.Pane,
Right.Panel and Right.Pane.
"""

import json
import struct

from make_testdata.solids import block


class Buffer:
    """The bytes of a BIN chunk, with the accessors of what was put into it."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []

    def put(self, kind, component, values, wide):
        """Adds numbers and returns the index of their accessor."""
        data = struct.pack(f"<{len(values)}{kind}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + b"\0" * (-len(data) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(values) // wide,
                    "type": "SCALAR" if wide == 1 else "VEC3"}
        if wide == 3:
            accessor |= {"min": [min(values[i::3]) for i in range(3)], "max": [max(values[i::3]) for i in range(3)]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def primitive(self, faces, material):
        """A primitive of faces of four corners, each given as (point, normal)."""
        corners = [corner for face in faces for corner in face]
        points, normals = ([round(v, 6) + 0.0 for corner in corners for v in corner[k]] for k in (0, 1))
        indices = [4 * i + k for i in range(len(faces)) for k in (0, 1, 2, 0, 2, 3)]
        return {"attributes": {"POSITION": self.put("f", 5126, points, 3), "NORMAL": self.put("f", 5126, normals, 3)},
                "indices": self.put("H", 5123, indices, 1), "material": material}


def doors_glb():
    """The bytes of doors.glb."""
    buffer = Buffer()
    steel, panel, pane = range(3)
    meshes = [{"name": "closet", "primitives": [buffer.primitive(block((0, -0.3), (0.6, 0.3), 0, 1.2), steel)]},
              {"name": "door", "primitives": [buffer.primitive(block((0.3, 0), (0.3, 0.02), 0, 0.8), panel),
                                              buffer.primitive(block((0.3, 0), (0.3, 0.01), 0.8, 1.2), pane)]}]
    half = 0.3826834323650898  # of 45 degrees about the vertical axis
    nodes = [{"name": "Closet", "mesh": 0, "translation": [0, 1, 0], "children": [1, 2]},
             {"name": "Left", "mesh": 1, "translation": [-0.6, 0, 0.03], "rotation": [0, -half, 0, 0.9238795325112867]},
             {"name": "Right", "mesh": 1, "translation": [0.6, 0, 0.03], "rotation": [0, half, 0, 0.9238795325112867],
              "scale": [-1, 1, 1]}]
    document = {"asset": {"version": "2.0", "generator": "scripts/make-testdata"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": nodes, "meshes": meshes, "materials": [{"name": name} for name in ("Steel", "Panel", "Pane")],
                "buffers": [{"byteLength": len(buffer.data)}], "bufferViews": buffer.views, "accessors": buffer.accessors}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer.data), b"BIN\0") + buffer.data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
