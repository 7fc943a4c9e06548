"""Draws one scene with Mitsuba 3, by paths, and says how long it took. Run it with a Python that has mitsuba and numpy:

  python draw_with_mitsuba.py SCENE.json OUT.npy

SCENE.json: variant; parts: [{positions, normals, triangles (paths of .npy), paint, emission}]; environment (.npy of a lat-long
picture, or null); eye, target, fov_deg, size [width, height]; bounces; samples (of a pixel, in each of the passes); passes; seed;
denoise: true for the last pass alone, as Open Image Denoise cleans it by the normals and by an even albedo.
A paint has table, the path of an RGL tensor file, or diffuse, lobes [[exponent, directional diffuse, gloss] ...] and mirror, as
goniochrome-lobes(7), "LOBE MODEL", has them.

OUT.npy holds the mean radiance of the passes. Rays go through the centers of the pixels. The last line of standard output is
JSON: version, the processor seconds of each pass after the first, of the first, first_s, which compiling is part of, and of the
second call of the denoiser, denoise_s.
"""

import json
import math
import sys
import time

import mitsuba as mi
import numpy

COAT_INDEX, GLOSS_DEG = 1.5, 45.0


def coat(cosine):
    """Fresnel's reflectance of the coat for unpolarized light."""
    contrast = COAT_INDEX ** 2 - 1
    g = dr.sqrt(contrast + cosine * cosine)
    s, p = cosine + g, COAT_INDEX ** 2 * cosine + g
    r_p = contrast * ((COAT_INDEX ** 2 + 1) * cosine * cosine - 1) / (p * p)
    r_s = contrast / (s * s)
    return 0.5 * (r_s * r_s + r_p * r_p)


def coat_at(angle_deg):
    """The same for one angle of incidence, as a number."""
    c = math.cos(math.radians(angle_deg))
    t = math.sqrt(1 - (1 - c * c) / COAT_INDEX ** 2)
    return 0.5 * (((c - COAT_INDEX * t) / (c + COAT_INDEX * t)) ** 2 + ((t - COAT_INDEX * c) / (t + COAT_INDEX * c)) ** 2)


def lobe_bsdf():
    """The class of the BSDF; Mitsuba's classes are there only when its variant is chosen."""

    class Lobes(mi.BSDF):
        """f cos_i = cos_i (K_D + sum K_DD cos^E) + F(theta_h)/F(45) sum K_G cos^E about the mirror direction; a mirror F K_M."""

        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            paint = json.loads(props["paint"])
            self.diffuse = paint["diffuse"]
            self.lobes = [(e, dd, [x / coat_at(GLOSS_DEG) for x in g]) for e, dd, g in paint["lobes"]]
            self.mirror = paint["mirror"]
            sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [mi.BSDFFlags.GlossyReflection | sides, mi.BSDFFlags.DeltaReflection | sides]
            self.m_flags = self.m_components[0] | (self.m_components[1] if any(self.mirror) else 0)

        def chances(self, cos_o):
            """What each part sends back of an even light, about: [diffuse, lobes ...], and the mirror."""
            fresnel = coat(cos_o)
            parts = [mi.Float(math.pi * sum(self.diffuse) / 3)]
            for e, dd, g in self.lobes:
                wide = 1 / math.sqrt(e + 2)
                parts.append((2 * math.pi / (e + 1) / 3) * ((cos_o + (1 - cos_o) * wide) * sum(dd) + fresnel * sum(g)))
            return parts, fresnel * (sum(self.mirror) / 3)

        def cosine_powers(self, wi, wo):
            """cos^E of each lobe about the mirror direction of wi."""
            cosine = -wi.x * wo.x - wi.y * wo.y + wi.z * wo.z
            log = dr.log(dr.maximum(cosine, 1e-20))
            return [dr.select(cosine > 0, dr.exp(e * log), 0) for e, _, _ in self.lobes]

        def value_and_density(self, wi, wo):
            """(f cos_i, the density of sample() without its mirror)"""
            powers, fresnel = self.cosine_powers(wi, wo), coat(0.5 * dr.norm(wi + wo))
            value, (parts, mirror) = wo.z * mi.Color3f(self.diffuse), self.chances(wi.z)
            density, total = parts[0] * wo.z / math.pi, parts[0] + mirror
            for power, part, (e, dd, g) in zip(powers, parts[1:], self.lobes):
                value += power * (wo.z * mi.Color3f(dd) + fresnel * mi.Color3f(g))
                density += part * power * ((e + 1) / (2 * math.pi))
                total += part
            above = (wi.z > 0) & (wo.z > 0)
            return dr.select(above, value, 0), dr.select(above & (total > 0), density / total, 0)

        @staticmethod
        def upward(w, side):
            return mi.Vector3f(w.x, w.y, w.z * side)

        def eval(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[1]

        def eval_pdf(self, ctx, si, wo, active=True):
            side = dr.sign(mi.Frame3f.cos_theta(si.wi))
            value, density = self.value_and_density(self.upward(si.wi, side), self.upward(wo, side))
            return value & active, dr.select(active, density, 0)

        def sample(self, ctx, si, sample1, sample2, active=True):
            side = dr.sign(mi.Frame3f.cos_theta(si.wi))
            wi = self.upward(si.wi, side)
            parts, mirror = self.chances(wi.z)
            total = sum(parts, mirror)
            left = sample1 * total
            specular = left < mirror
            left -= mirror
            wo = mi.warp.square_to_cosine_hemisphere(sample2)
            mirrored = mi.Vector3f(-wi.x, -wi.y, wi.z)
            frame = mi.Frame3f(mirrored)
            left -= parts[0]
            exponent = mi.Float(0)
            for part, (e, _, _) in zip(parts[1:], self.lobes):
                exponent = dr.select(left >= 0, e, exponent)
                left -= part
            in_lobe = sample1 * total >= mirror + parts[0]
            versine = 1 - dr.power(sample2.x, 1 / (exponent + 1))
            sine, phi = dr.sqrt(dr.maximum(0, versine * (2 - versine))), 2 * math.pi * sample2.y
            about = frame.to_world(mi.Vector3f(sine * dr.cos(phi), sine * dr.sin(phi), 1 - versine))
            wo = dr.select(specular, mirrored, dr.select(in_lobe, about, wo))
            value, density = self.value_and_density(wi, wo)
            chance = mirror / total
            bs = mi.BSDFSample3f()
            bs.wo = self.upward(wo, side)
            bs.pdf = dr.select(specular, chance, density)
            bs.eta = 1.0
            bs.sampled_component = dr.select(specular, mi.UInt32(1), mi.UInt32(0))
            bs.sampled_type = dr.select(specular, mi.UInt32(+mi.BSDFFlags.DeltaReflection), mi.UInt32(+mi.BSDFFlags.GlossyReflection))
            active = active & (bs.pdf > 0) & (total > 0) & (wo.z > 0) & (wi.z > 0)
            weight = dr.select(specular, coat(wi.z) * mi.Color3f(self.mirror), value) / bs.pdf
            return bs, dr.select(active, weight, 0)

        def traverse(self, callback):
            pass

        def to_string(self):
            return "Lobes[]"

    return Lobes


def is_diffuse(paint):
    return not paint["lobes"] and not any(paint["mirror"])


def mesh_of(part, number):
    """A mesh with its paint, as Mitsuba has it."""
    positions, normals, triangles = (numpy.load(part[key]) for key in ("positions", "normals", "triangles"))
    paint = part["paint"]
    if "table" in paint:
        bsdf = {"type": "measured", "filename": paint["table"]}
    elif is_diffuse(paint):
        bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": {
            "type": "rgb", "value": [math.pi * value for value in paint["diffuse"]]}}}
    else:
        bsdf = {"type": "lobes", "paint": json.dumps(paint)}
    props = mi.Properties()
    props["mesh_bsdf"] = mi.load_dict(bsdf)
    if any(part["emission"]):
        props["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": part["emission"]}})
    mesh = mi.Mesh(f"part{number}", len(positions), len(triangles), props=props, has_vertex_normals=True)
    params = mi.traverse(mesh)
    params["vertex_positions"] = mi.Float(positions.astype(numpy.float32).ravel())
    params["vertex_normals"] = mi.Float(normals.astype(numpy.float32).ravel())
    params["faces"] = mi.UInt32(triangles.astype(numpy.uint32).ravel())
    params.update()
    return mesh


def scene_of(told):
    """The scene, with its integrator."""
    scene = {"type": "scene"}
    for number, part in enumerate(told["parts"]):
        scene[f"part{number}"] = mesh_of(part, number)
    if told["environment"]:
        picture = mi.Bitmap(numpy.load(told["environment"]).astype(numpy.float32))
        # The center of the picture looks along +Z and its left quarter along +X, as in ours.
        scene["sky"] = {"type": "envmap", "bitmap": picture}
    return mi.load_dict(scene)


def center_rays(told):
    """The rays through the centers of all pixels, row by row."""
    width, height = told["size"]
    eye, target = (numpy.array(told[key], float) for key in ("eye", "target"))
    forward = (target - eye) / numpy.linalg.norm(target - eye)
    right = numpy.cross(forward, (0, 1, 0))
    right /= numpy.linalg.norm(right)
    up = numpy.cross(right, forward)
    half = math.tan(math.radians(told["fov_deg"] / 2))
    x = ((numpy.arange(width) + 0.5) / width * 2 - 1) * half * width / height
    y = (1 - (numpy.arange(height) + 0.5) / height * 2) * half
    way = forward + x[None, :, None] * right + y[:, None, None] * up
    way /= numpy.linalg.norm(way, axis=-1, keepdims=True)
    return eye, way.reshape(-1, 3)


def denoised(scene, eye, ways, noisy):
    """(the picture as Open Image Denoise cleans it, the processor seconds that it took once it was set up)"""
    import pyoidn  # only where it is asked for

    way = mi.Vector3f(*(mi.Float(ways[:, c].astype(numpy.float32)) for c in range(3)))
    seen = scene.ray_intersect(mi.Ray3f(mi.Point3f(*map(float, eye)), way))
    normal = numpy.stack([numpy.array(dr.select(seen.is_valid(), seen.sh_frame.n[c], 0)) for c in range(3)], -1)
    albedo = numpy.where(numpy.array(seen.is_valid())[:, None], (0.5, 0.5, 0.5), (1, 1, 1)).astype(numpy.float32)
    guides = {"albedo": albedo.reshape(noisy.shape), "normal": normal.astype(numpy.float32).reshape(noisy.shape)}
    for _ in range(2):
        began = time.process_time()
        clean = pyoidn.denoise(noisy, hdr=True, **guides)
        seconds = time.process_time() - began
    return clean, seconds


def main():
    global dr
    with open(sys.argv[1], encoding="utf-8") as file:
        told = json.load(file)
    mi.set_variant(told["variant"])
    import drjit as dr  # of the variant

    mi.register_bsdf("lobes", lambda props: lobe_bsdf()(props))
    mi.set_log_level(mi.LogLevel.Error)
    scene = scene_of(told)
    integrator = mi.load_dict({"type": "path", "max_depth": told["bounces"] + 2, "rr_depth": 4})
    eye, ways = center_rays(told)
    samples, pixels = told["samples"], len(ways)
    at = dr.repeat(dr.arange(mi.UInt32, pixels), samples)
    way = mi.Vector3f(*(dr.gather(mi.Float, mi.Float(ways[:, c].astype(numpy.float32)), at) for c in range(3)))
    ray = mi.RayDifferential3f(mi.Ray3f(mi.Point3f(*map(float, eye)), way))
    dr.eval(ray)
    seconds, total = [], 0.0
    for number in range(told["passes"]):
        began = time.process_time()
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(told["seed"] + number, pixels * samples)
        color = integrator.sample(scene, sampler, ray)[0]
        sums = [numpy.array(dr.block_reduce(dr.ReduceOp.Add, color[c], samples)) for c in range(3)]
        total = total + numpy.stack(sums, -1).astype(float) / samples
        seconds.append(time.process_time() - began)
    width, height = told["size"]
    said = {"version": mi.__version__, "seconds": seconds[1:] or seconds, "first_s": seconds[0]}
    if told.get("denoise"):
        total = numpy.stack(sums, -1) / samples
        picture, said["denoise_s"] = denoised(scene, eye, ways, total.reshape(height, width, 3).astype(numpy.float32))
    else:
        picture = (total / told["passes"]).reshape(height, width, 3).astype(numpy.float32)
    numpy.save(sys.argv[2], picture)
    print(json.dumps(said))


if __name__ == "__main__":
    main()
