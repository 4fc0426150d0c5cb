"""Triangles as pixels, without a display: a depth buffer in numpy."""
import numpy as np

OVERSAMPLING = 2  # pixels of the buffer for one of the picture, each way
MOST_SAMPLES = 3_000_000  # at a time
LARGEST = 2048  # pixels of the buffer along a triangle; larger ones, most of them outside the window, are taken in quarters


class View:
    """A direction of view (towards the eye), and the window that shows given points."""

    def __init__(self, direction, points, width, height, margin=0.04):
        self.direction = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
        upward = np.array([0.0, 1.0, 0.0]) if abs(self.direction[2]) > 0.95 else np.array([0.0, 0.0, 1.0])
        self.right = np.cross(upward, self.direction)
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.direction, self.right)
        self.width, self.height = width, height
        flat = points @ np.stack([self.right, self.up], axis=1)
        low, high = flat.min(axis=0), flat.max(axis=0)
        size = np.maximum(high - low, 1e-12 * max(np.abs(flat).max(), 1e-300))
        self.scale = (1 - 2 * margin) * min(width / size[0], height / size[1])
        self.middle = (low + high) / 2

    def pixels(self, points):
        """Places in the picture, from its lower left corner."""
        flat = points @ np.stack([self.right, self.up], axis=1)
        return (flat - self.middle) * self.scale + np.array([self.width, self.height]) / 2


def _quarters(corners, values):
    """Points, triangles and values of triangles that are cut in four."""
    middle = lambda x: (x + np.roll(x, -1, axis=1)) / 2  # of the edges 01, 12, 20
    six = np.arange(len(corners))[:, None] * 6
    triangles = np.concatenate([six + np.array(t) for t in ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))], axis=1).reshape(-1, 3)
    points = np.concatenate([corners, middle(corners)], axis=1).reshape(-1, 3)
    return points, triangles, np.concatenate([values, middle(values)], axis=1).ravel()


class Buffer:
    """What is seen of triangles: at each pixel the number of its mesh (-1: none), its value and how bright it is."""

    def __init__(self, view):
        self.view = view
        self.shape = (view.height * OVERSAMPLING, view.width * OVERSAMPLING)
        count = self.shape[0] * self.shape[1]
        self.depth = np.full(count, -np.inf)
        self.value = np.zeros(count, dtype=np.float32)
        self.light = np.ones(count, dtype=np.float32)
        self.mesh = np.full(count, -1, dtype=np.int32)

    def draw(self, points, triangles, values, number=0, lit=True):
        """`number` may be an array, one for each triangle: lines are drawn where numbers change."""
        number = np.broadcast_to(number, len(triangles))
        place = self.view.pixels(points) * OVERSAMPLING
        depth = points @ self.view.direction
        corners = place[triangles]
        low, high = corners.min(axis=1), corners.max(axis=1)
        inside = (high[:, 0] >= 0) & (high[:, 1] >= 0) & (low[:, 0] < self.shape[1]) & (low[:, 1] < self.shape[0])
        triangles, corners, number, extent = triangles[inside], corners[inside], number[inside], (high - low)[inside].max(axis=1)
        large = extent > LARGEST
        if large.any():
            self.draw(*_quarters(points[triangles[large]], values[triangles[large]]), np.repeat(number[large], 4), lit)
            triangles, corners, number, extent = triangles[~large], corners[~large], number[~large], extent[~large]
        if len(triangles) == 0:
            return
        light = np.ones(len(triangles))
        if lit:
            p = points[triangles]
            normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
            light = 0.55 + 0.45 * np.abs(normal @ self.view.direction) / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
        # Samples on a grid of barycentric coordinates that is finer than the pixels; triangles of about one size at a time.
        level = np.ceil(np.log2(np.maximum(1.5 * extent, 1))).astype(int)
        for of_size in np.unique(level):
            chosen = np.flatnonzero(level == of_size)
            n = 2 ** int(of_size)
            i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
            keep = i + j <= n
            weights = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], axis=1) / n
            step = max(1, MOST_SAMPLES // len(weights))
            for start in range(0, len(chosen), step):
                some = chosen[start : start + step]
                mine = triangles[some]
                x = (corners[some, :, 0] @ weights.T).ravel()
                y = (corners[some, :, 1] @ weights.T).ravel()
                column, row = np.floor(x).astype(int), np.floor(y).astype(int)
                seen = np.flatnonzero((column >= 0) & (row >= 0) & (column < self.shape[1]) & (row < self.shape[0]))
                at = row[seen] * self.shape[1] + column[seen]
                near = (depth[mine] @ weights.T).ravel()[seen]
                front = near > self.depth[at]
                seen, at, near = seen[front], at[front], near[front]
                order = np.argsort(near, kind="stable")  # of several samples in a pixel the nearest is written last
                seen, at = seen[order], at[order]
                self.depth[at] = near[order]
                self.value[at] = (values[mine] @ weights.T).ravel()[seen]
                self.light[at] = np.repeat(light[some], len(weights))[seen]
                self.mesh[at] = np.repeat(number[some], len(weights))[seen]

    def image(self, colours):
        """RGB in rows from the top: `colours` makes RGB of values; lines where one mesh ends."""
        rgb = np.ones((self.mesh.size, 3))
        drawn = self.mesh >= 0
        rgb[drawn] = colours(self.value[drawn])[:, :3] * self.light[drawn, None]
        rgb = rgb.reshape(*self.shape, 3)
        mesh = self.mesh.reshape(self.shape)
        edge = np.zeros(self.shape, dtype=bool)
        edge[:, 1:] |= mesh[:, 1:] != mesh[:, :-1]
        edge[1:] |= mesh[1:] != mesh[:-1]
        rgb[edge] *= 0.35
        h, w = self.view.height, self.view.width
        return rgb.reshape(h, OVERSAMPLING, w, OVERSAMPLING, 3).mean(axis=(1, 3))[::-1]

    def mask(self):
        """How much of each pixel is covered, 0 to 1, in rows from the top."""
        covered = (self.mesh >= 0).reshape(self.view.height, OVERSAMPLING, self.view.width, OVERSAMPLING)
        return covered.mean(axis=(1, 3))[::-1]
