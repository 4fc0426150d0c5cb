"""The .vtu files that Mortise writes, without a library for VTK: meshio refuses files with arrays of words."""

import base64
import pathlib
import re
import zlib

import numpy as np

TYPES = {"Float64": np.float64, "Float32": np.float32, "Int64": np.int64, "Int32": np.int32, "UInt8": np.uint8}
NAMES = {3: "line", 21: "line3", 5: "triangle", 22: "triangle6", 9: "quad", 23: "quad8", 28: "quad9"}  # of facets, by VTK's numbers


def unpacked(text):
    """The bytes of an array: base64 of a head of four-byte numbers (blocks, size of a block, size of the last, sizes of all as they are
    packed), and of the blocks."""
    count = int(np.frombuffer(base64.b64decode(text[:8])[:4], "<u4")[0])
    length = 4 * -(-4 * (3 + count) // 3)
    sizes = np.frombuffer(base64.b64decode(text[:length])[: 4 * (3 + count)], "<u4")[3:]
    data, parts, at = base64.b64decode(text[length:]), [], 0
    for size in sizes:
        parts.append(zlib.decompress(data[at : at + int(size)]))
        at += int(size)
    return b"".join(parts)


def read_vtu(path):
    """{section: {name: array}} of a .vtu file."""
    result = {}
    for section, body in re.findall(r"<(PointData|CellData|Points|Cells)>(.*?)</\1>", pathlib.Path(path).read_text(), re.S):
        arrays = result.setdefault(section, {})
        for tag, text in re.findall(r"<DataArray([^>]*)>([^<]*)", body):
            field = dict(re.findall(r'(\w+)="([^"]*)"', tag))
            values = np.frombuffer(unpacked(text.strip()), TYPES[field["type"]])
            columns = int(field.get("NumberOfComponents", 1))
            arrays[field["Name"]] = values.reshape(-1, columns) if columns > 1 else values
    return result
