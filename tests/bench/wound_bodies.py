"""Bodies with wounds of known volume for the virtual rig, made here and not by the program under test.

A body is a parametrised skin S(u, v) (mm; u across, v down the body, front towards -z). The wound moves each point by
-d(rho) along the skin's own normal, rho = 1 on the outline, so that depths are exact; the volume is the closed volume
between the two triangulated sheets inside the outline, the area that of the skin's triangles."""
import numpy as np

FINE, COARSE = 0.25, 1.5  # mm; facets deviate by less than 0.01 mm at the rims' curvatures


def limb(rng, radius, bulge=0.0):
    """A tapering limb with a slightly three-cornered section; `bulge` is the calf's, as a share of the radius."""
    phase, place = rng.uniform(0, 6.28), rng.uniform(-60, 60)

    def skin(u, v):
        angle = u / radius
        r = radius * (1 - 0.0006 * v + bulge * np.exp(-((v - place) / 110) ** 2))
        r = r * (1 + 0.03 * np.cos(2 * angle + phase) + 0.012 * np.cos(3 * angle))
        return np.stack([r * np.sin(angle), v, radius - r * np.cos(angle)], -1)
    return skin, (-2.2 * radius, 2.2 * radius)


def heel(rng, radius):
    """A limb that swells to a double curvature of about `radius` both ways."""
    length = np.sqrt(2 * 0.3 * radius * radius)

    def skin(u, v):
        angle = u / radius
        r = radius * (0.7 + 0.3 * np.exp(-(v / length) ** 2))
        return np.stack([r * np.sin(angle), v, radius - r * np.cos(angle)], -1)
    return skin, (-2.2 * radius, 2.2 * radius)


def flat(rng, _):
    """A back: waves of up to 3 mm, 150 mm and longer."""
    waves = []
    for _ in range(3):
        way, k = rng.uniform(0, 6.28), 2 * np.pi / rng.uniform(150, 400)
        waves.append((rng.uniform(0.5, 3), k * np.cos(way), k * np.sin(way), rng.uniform(0, 6.28)))

    def skin(u, v):
        z = sum(a * np.sin(kx * u + ky * v + p) for a, kx, ky, p in waves)
        return np.stack([u, v, z], -1)
    return skin, (-210, 210)


def crater(rng, depth, radius, oedema=0.0):
    """rho(u, v) and the displacement into the body (mm); an irregular ellipse, wall from gentle to steep, uneven bed."""
    wall = rng.choice([2.5, 4, 6, 8])
    stretch, turn = rng.uniform(1, 1.6), rng.uniform(0, np.pi)
    lobes = [(k, rng.uniform(0, a), rng.uniform(0, 6.28)) for k, a in ((2, 0.05), (3, 0.08), (5, 0.03))]
    waves, width = rng.uniform(0, 6.28, 4), rng.uniform(3, 7)

    def rho(u, v):
        a, b = np.cos(turn) * u + np.sin(turn) * v, -np.sin(turn) * u + np.cos(turn) * v
        b = b / stretch
        angle = np.arctan2(b, a)
        return np.hypot(a, b) / radius / (1 + sum(s * np.cos(k * angle + p) for k, s, p in lobes))

    def displacement(u, v):
        r = rho(u, v)
        bed = 1 - 0.12 * (1 + np.sin(4 * u / radius + waves[0]) * np.sin(4 * v / radius + waves[1])) / 2
        hole = depth * bed * np.where(r < 1, (1 - np.minimum(r, 1) ** wall) ** 2, 0)
        distance = (r - 1) * radius
        return hole - oedema * np.exp(-0.5 * (distance / width) ** 2)
    return rho, displacement, {"wall": float(wall), "oedema_width_mm": float(width)}


def normals(skin, u, v, h=1e-3):
    a = skin(u + h, v) - skin(u - h, v)
    b = skin(u, v + h) - skin(u, v - h)
    n = np.cross(b, a)  # towards -z: outwards
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def knots(low, high, fine):
    n = int(np.ceil((high - low) / COARSE))
    coarse = np.linspace(low, high, n + 1)
    return np.concatenate([coarse[coarse < -fine], np.arange(-fine, fine, FINE), coarse[coarse >= fine]])


def grid_triangles(rows, cols):
    a = (np.arange(rows - 1)[:, None] * cols + np.arange(cols - 1)).ravel()
    return np.concatenate([np.stack([a, a + 1, a + cols], 1), np.stack([a + 1, a + cols + 1, a + cols], 1)])


def triangle_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def wedges(upper, lower, triangles):
    """Signed volumes between the triangles of two sheets, each as three tetrahedra."""
    a, b, c = (upper[triangles[:, k]] for k in range(3))
    p, q, r = (lower[triangles[:, k]] for k in range(3))

    def tetrahedron(o, x, y, z):
        return np.einsum("ij,ij->i", x - o, np.cross(y - o, z - o)) / 6
    return tetrahedron(a, b, c, r) + tetrahedron(a, b, r, q) + tetrahedron(a, q, r, p)


def rim(skin, rho, radius):
    """720 points on the skin where rho is 1."""
    angle = np.linspace(0, 2 * np.pi, 721)[:-1]
    lo, hi = np.zeros(720), np.full(720, 3 * radius)
    for _ in range(50):
        mid = (lo + hi) / 2
        out = rho(mid * np.cos(angle), mid * np.sin(angle)) > 1
        lo, hi = np.where(out, lo, mid), np.where(out, mid, hi)
    return skin(lo * np.cos(angle), lo * np.sin(angle))


def body_and_wound(kind, seed, depth, radius, body_radius, oedema=0.0):
    """The skin and its span across, the wound's rho and displacement, and what of the truth is drawn by lot."""
    rng = np.random.default_rng(seed)
    skin, span = {"limb": lambda: limb(rng, body_radius), "calf": lambda: limb(rng, body_radius, 0.12),
                  "heel": lambda: heel(rng, body_radius), "flat": lambda: flat(rng, 0)}[kind]()
    return skin, span, *crater(rng, depth, radius, oedema)


def make(kind, seed, depth, radius, body_radius, oedema=0.0):
    """Vertices (mm), triangles, colours, outline points on the skin (72) and the truth."""
    skin, (low, high), rho, displacement, truth = body_and_wound(kind, seed, depth, radius, body_radius, oedema)
    fine = 1.9 * radius + (25 if oedema else 2)
    us, vs = knots(low, high, min(fine, 0.9 * high)), knots(-230, 230, fine)
    u, v = np.meshgrid(us, vs)
    whole = skin(u, v)
    d = displacement(u, v)
    body = whole - d[..., None] * normals(skin, u, v)
    triangles = grid_triangles(len(vs), len(us))
    r = rho(u, v).ravel()
    inside = r[triangles].mean(1) < 1
    flat_whole, flat_body = whole.reshape(-1, 3), body.reshape(-1, 3)
    areas = triangle_areas(flat_whole, triangles[inside])
    # Below and above apart: the volume of the wedges between skin and what lies below it.
    lower = (whole - np.maximum(d, 0)[..., None] * normals(skin, u, v)).reshape(-1, 3)
    volume = abs(wedges(flat_whole, lower, triangles[inside]).sum())
    line = rim(skin, rho, radius)
    shade = 1 + 0.08 * np.sin(u / 7 + 2 * np.sin(v / 11)) * np.sin(v / 9 + 1.3)
    bed = np.clip((1.03 - r.reshape(u.shape)) / 0.06, 0, 1)[..., None]
    colour = (1 - bed) * np.array([200, 160, 140]) + bed * np.array([178, 100, 90])
    colour = np.clip(colour * shade[..., None], 0, 255).astype(np.uint8).reshape(-1, 3)
    truth |= {"kind": kind, "volume_ml": volume / 1000, "area_cm2": areas.sum() / 100,
              "depth_mm": float(d.max()),
              "perimeter_mm": float(np.linalg.norm(line - np.roll(line, 1, 0), axis=1).sum()), "mean_depth_mm": volume / areas.sum(), "oedema_mm": oedema}
    return flat_body, triangles, colour, line[::10], truth


def write_ply(path, points, triangles, colour):
    vertex = np.empty(len(points), [("p", "<f4", 3), ("c", "u1", 3)])
    vertex["p"], vertex["c"] = points, colour
    while vertex[:1].tobytes()[0] in b"\t\n\r ":  # readers that skip white space after the header would lose it
        vertex["p"][0] += 1e-4
    face = np.empty(len(triangles), [("n", "u1"), ("v", "<i4", 3)])
    face["n"], face["v"] = 3, triangles
    with open(path, "wb") as file:
        file.write(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
                   "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                   f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode())
        file.write(vertex.tobytes())
        file.write(face.tobytes())


def project(camera, points):
    x, y = points[:, 0] / points[:, 2], points[:, 1] / points[:, 2]
    r2 = x * x + y * y
    m = 1 + camera["k1"] * r2 + camera["k2"] * r2 * r2
    p1, p2 = camera["p1"], camera["p2"]
    xd = x * m + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    yd = y * m + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([camera["fx"] * xd + camera["cx"], camera["fy"] * yd + camera["cy"]], 1)


def rotation(x_deg, y_deg, z_deg):
    a, b, c = np.radians([x_deg, y_deg, z_deg])
    rx = np.array([[1, 0, 0], [0, np.cos(a), -np.sin(a)], [0, np.sin(a), np.cos(a)]])
    ry = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]])
    rz = np.array([[np.cos(c), -np.sin(c), 0], [np.sin(c), np.cos(c), 0], [0, 0, 1]])
    return rz @ ry @ rx
