"""Bodies for the head table from public meshes: a rigged human body (MakeHuman), made into different people by smooth
random deformation, whose head turns by a known rotation while it breathes, shrugs, opens its mouth and wears other hair.

Camera axes (x right, y down, z away) and mm, origin at the neck's pivot; the subject faces the camera."""
import json
import os

import numpy as np

DM = 100.0  # the file's unit, mm
HEAD_TREE_ROOT = "head"


def rotation_from_vector(vector_rad):
    """Rodrigues' formula."""
    angle = np.linalg.norm(vector_rad)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector_rad / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def vector_from_rotation(rotation):
    """The inverse, below 180 degrees."""
    angle = np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1))
    axis = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    norm = np.linalg.norm(axis)
    return np.zeros(3) if norm < 1e-12 else axis / norm * angle


def smooth_noise(points, random, wavelength_mm, amount_mm, waves=8):
    """A smooth random function of space: a sum of plane waves, root mean square `amount_mm`."""
    value = np.zeros(len(points))
    for _ in range(waves):
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        value += np.sin(points @ direction * 2 * np.pi / (wavelength_mm * random.uniform(0.7, 1.4)) + random.uniform(0, 2 * np.pi))
    return amount_mm * value * np.sqrt(2.0 / waves)


def vertex_normals(points, faces):
    a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
    facing = np.cross(b - a, c - a)
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], facing)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)


class MakeHuman:
    """The body of makehuman/base.obj with the parts of its skeleton that matter here."""

    def __init__(self, folder, person):
        vertices, faces, group = [], [], ""
        with open(os.path.join(folder, "base.obj")) as file:
            for line in file:
                words = line.split()
                if not words:
                    continue
                if words[0] == "v":
                    vertices.append([float(w) for w in words[1:4]])
                elif words[0] == "g":
                    group = words[1]
                elif words[0] == "f" and group == "body":
                    corners = [int(w.split("/")[0]) - 1 for w in words[1:]]
                    faces += [[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]
        skeleton = json.load(open(os.path.join(folder, "default.mhskel")))
        weights = json.load(open(os.path.join(folder, "default_weights.mhw")))["weights"]
        points = np.array(vertices) * DM * [1, -1, -1]
        joint = {name: points[indices].mean(axis=0) for name, indices in skeleton["joints"].items()}
        bones = skeleton["bones"]
        pivot = joint[bones["neck02"]["head"]]
        used = np.unique(faces)
        renumber = np.full(len(points), -1)
        renumber[used] = np.arange(len(used))
        self.faces = renumber[np.array(faces)]
        self.points = points[used] - pivot
        self.jaw_joint = joint[bones["jaw"]["head"]] - pivot
        self.shoulder_joint = {side: joint[bones["clavicle." + side]["head"]] - pivot for side in "LR"}

        def below(root):
            found = {root}
            while True:
                more = {name for name, bone in bones.items() if bone["parent"] in found} - found
                if not more:
                    return found
                found |= more

        def total(names):
            sums = np.zeros(len(points))
            for name in names:
                for index, weight in weights.get(name, []):
                    sums[index] += weight
            return sums[used]

        self.arms = {side: total(below("clavicle." + side)) for side in "LR"}
        self.jaw = total(below("jaw"))
        self.head = total(below(HEAD_TREE_ROOT)) - self.jaw
        self.neck = [total([name]) for name in ("neck01", "neck02", "neck03")]
        every = np.maximum(total(list(weights)), 1e-9)
        for part in (*self.arms.values(), self.jaw, self.head, *self.neck):
            part /= every
        self._become(person)

    def _become(self, person):
        """Another person: breadth, depth and height of head, neck and chest, and features of their own."""
        if person == 0:
            return
        random = np.random.default_rng(1000 + person)
        y = self.points[:, 1]
        knots = np.array([-400, -220, -120, -40, 60, 200, 400, 2000.0])
        for axis, spread in ((0, 0.08), (2, 0.08)):
            self.points[:, axis] *= 1 + np.interp(y, knots, spread * random.uniform(-1, 1, len(knots)))
        self.points[:, 1] *= 1 + np.where(y < 0, 0.06, 0.04) * random.uniform(-1, 1)
        normals = vertex_normals(self.points, self.faces)
        self.points += normals * (smooth_noise(self.points, random, 90, 1.5) + smooth_noise(self.points, random, 250, 3))[:, None]

    def posed(self, head_rotation, random, breath_mm=0.0, shrug_deg=0.0, mouth_deg=0.0, hair_mm=0.0):
        """Points and linear colours with the head turned by `head_rotation`; exactly the torso's and the head's own
        vertices move rigidly. `random` is of this capture: its hair."""
        points = self.points.copy()
        colours = np.repeat([[0.62, 0.42, 0.33]], len(points), axis=0)
        tone = 1 + np.clip(smooth_noise(points, np.random.default_rng(5), 12, 0.05), -0.15, 0.15)
        colours *= tone[:, None]
        normals = vertex_normals(points, self.faces)
        height = -points[:, 1]
        if hair_mm > 0:
            top = height.max()
            front = -points[:, 2] - np.interp(height, [0.45 * top, 0.8 * top, top], [-55, 45, 200])
            scalp = np.clip(-front / 8, 0, 1) * (height > 0.35 * top) * (self.head > 0.5)
            thick = hair_mm * (1 + np.clip(smooth_noise(points, random, 25, 0.35), -0.8, 0.8))
            points += normals * (scalp * thick)[:, None]
            colours = np.where(scalp[:, None] > 0.5, [[0.10, 0.07, 0.05]], colours)
        if breath_mm != 0:
            # A breath lifts the chest's front: most at the lower breastbone, nothing at the collar.
            chest = np.exp(-((height + 190) / 110) ** 2) * (points[:, 2] < 20) * (np.abs(points[:, 0]) < 170)
            points += np.array([0, -0.5, -1.0]) * (breath_mm * chest)[:, None]
        for side in "LR":
            if shrug_deg != 0:
                turn = rotation_from_vector(np.radians(shrug_deg) * np.array([0, 0, -1.0 if side == "L" else 1.0]))
                joint = self.shoulder_joint[side]
                points += self.arms[side][:, None] * ((points - joint) @ turn.T + joint - points)
        if mouth_deg != 0:
            turn = rotation_from_vector(np.radians(mouth_deg) * np.array([-1.0, 0, 0]))
            points += self.jaw[:, None] * ((points - self.jaw_joint) @ turn.T + self.jaw_joint - points)
        vector = vector_from_rotation(head_rotation)
        moved = np.zeros_like(points)
        left = np.ones(len(points))
        for share, weight in ((1 / 4, self.neck[0]), (1 / 2, self.neck[1]), (3 / 4, self.neck[2]), (1, self.head + self.jaw)):
            moved += weight[:, None] * (points @ rotation_from_vector(share * vector).T)
            left -= weight
        return moved + np.clip(left, 0, None)[:, None] * points, colours


def write_obj(path, points, colours, faces):
    """Vertex colours as sRGB."""
    srgb = np.where(colours <= 0.0031308, 12.92 * colours, 1.055 * np.maximum(colours, 1e-9) ** (1 / 2.4) - 0.055)
    with open(path, "w") as file:
        for p, c in zip(points, np.clip(srgb, 0, 1)):
            file.write(f"v {p[0]:.4f} {p[1]:.4f} {p[2]:.4f} {c[0]:.4f} {c[1]:.4f} {c[2]:.4f}\n")
        for f in faces + 1:
            file.write(f"f {f[0]} {f[1]} {f[2]}\n")
