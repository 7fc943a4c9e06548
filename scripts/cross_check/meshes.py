"""Meshes as numpy arrays, part by part, for programs that take no OBJ with several paints."""

import numpy


def read_obj(path):
    """[(part, positions, normals, triangles)] of an OBJ; equal pairs of point and normal are one vertex.

    Parts are its objects. A corner without a normal gets that of its face.
    """
    points, normals, parts, corners = [], [], {}, None
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                points.append(tuple(map(float, words[1:4])))
            elif words[0] == "vn":
                normals.append(tuple(map(float, words[1:4])))
            elif words[0] == "o":
                corners = parts.setdefault(" ".join(words[1:]), [])
            elif words[0] == "f":
                if corners is None:
                    corners = parts.setdefault("mesh", [])
                face = []
                for word in words[1:]:
                    fields = word.split("/")
                    point = int(fields[0])
                    normal = int(fields[2]) if len(fields) > 2 and fields[2] else 0
                    face.append((point - 1 if point > 0 else len(points) + point,
                                 normal - 1 if normal > 0 else len(normals) + normal if normal else -1))
                corners.append(face)
    return [(name, *arrays(points, normals, faces)) for name, faces in parts.items() if faces]


def arrays(points, normals, faces):
    """(positions, normals, triangles) of the faces, which are cut into fans."""
    positions, directions, triangles, numbers = [], [], [], {}

    def vertex(corner, face_normal):
        point, normal = corner
        key = corner if normal >= 0 else (point, tuple(face_normal))
        if key not in numbers:
            numbers[key] = len(positions)
            positions.append(points[point])
            directions.append(normals[normal] if normal >= 0 else face_normal)
        return numbers[key]

    for face in faces:
        face_normal = (0.0, 1.0, 0.0)
        if face[0][1] < 0:
            a, b, c = (numpy.array(points[face[k][0]]) for k in range(3))
            across = numpy.cross(b - a, c - a)
            face_normal = tuple(across / max(numpy.linalg.norm(across), 1e-300))
        at = [vertex(corner, face_normal) for corner in face]
        triangles += [(at[0], at[k], at[k + 1]) for k in range(1, len(at) - 1)]
    return numpy.array(positions), numpy.array(directions), numpy.array(triangles)
