"""Files of surface metrology by their documented formats, for tests: heights as bytes."""

import io
import struct
import zipfile

import numpy as np

MAIN = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
<Record1><Revision>ISO5436 - 2000</Revision><FeatureType>SUR</FeatureType><Axes>
<CX><AxisType>I</AxisType><DataType>L</DataType><Increment>{dx!r}</Increment><Offset>0</Offset></CX>
<CY><AxisType>I</AxisType><DataType>L</DataType><Increment>{dy!r}</Increment><Offset>0</Offset></CY>
<CZ><AxisType>A</AxisType><DataType>{kind}</DataType><Increment>{scale!r}</Increment><Offset>{offset!r}</Offset></CZ>
</Axes></Record1>
<Record2><Date>2026-11-23T03:00:00</Date></Record2>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
<DataLink><PointDataLink>bindata/data.bin</PointDataLink>{valid}</DataLink></Record3>
</p:ISO5436_2>
"""


def archived(members):
    """A ZIP archive of name → bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return stream.getvalue()


def x3p_members(heights, dx, dy, kind="D", scale=1e-6):
    """Members of an X3P file (ISO 25178-72): kind D double, F single, L and I whole numbers of `scale`, m."""
    ny, nx = heights.shape
    known = np.isfinite(heights)
    dtype = {"D": "<f8", "F": "<f4", "L": "<i4", "I": "<i2"}[kind]
    whole = kind in "LI"
    raw = np.round(np.where(known, heights, 0.0) / scale) if whole else heights
    head = MAIN.format(
        dx=dx, dy=dy, kind=kind, scale=scale if whole else 1.0, offset=0.0, nx=nx, ny=ny,
        valid="<ValidPointsLink>bindata/valid.bin</ValidPointsLink>" if whole else "",
    )  # fmt: skip
    members = {"main.xml": head.encode(), "bindata/data.bin": raw.astype(dtype).tobytes()}
    if whole:
        members["bindata/valid.bin"] = np.packbits(known.ravel(), bitorder="little").tobytes()
    return members


def x3p(heights, dx, dy, kind="D"):
    return archived(x3p_members(heights, dx, dy, kind))


def sdf_binary(heights, dx, dy, scale=1e-6):
    """ISO 25178-71, 32-bit whole numbers; the smallest marks a point that was not measured."""
    ny, nx = heights.shape
    head = struct.pack(
        "<8s10s12s12sHH4d3B", b"bISO-1.0", b"treadload", b"231120260300", b"231120260300", nx, ny, dx, dy, scale,
        0.0, 0, 6, 0,
    )  # fmt: skip
    raw = np.where(np.isfinite(heights), np.round(heights / scale), -(2.0**31))
    return head + raw.astype("<i4").tobytes()


def sdf_text(heights, dx, dy, scale=1e-6):
    ny, nx = heights.shape
    fields = {
        "ManufacID": "treadload", "CreateDate": "231120260300", "ModDate": "231120260300", "NumPoints": nx,
        "NumProfiles": ny, "Xscale": dx, "Yscale": dy, "Zscale": scale, "Zresolution": 1e-9, "Compression": 0,
        "DataType": 7, "CheckType": 0,
    }  # fmt: skip
    lines = ["aISO-1.0", *(f"{key} = {value}" for key, value in fields.items()), "*"]
    lines += [" ".join("BAD" if np.isnan(one) else f"{one / scale:.6f}" for one in row) for row in heights]
    return "\n".join([*lines, "*", ""]).encode()


def sur(heights, dx, dy, scale=1e-6, *, kind=2, objects=1, unit=b"mm", comment=b"a comment"):
    """Digital Surf, 512 bytes of header; points that were not measured are two below the smallest."""
    ny, nx = heights.shape
    per = {b"mm": 1e3, b"um": 1e6, b"m": 1.0}.get(unit, 1e3)
    known = np.isfinite(heights)
    raw = np.round(np.where(known, heights, 0.0) / scale).astype(np.int64)
    low, high = int(raw[known].min()), int(raw[known].max())
    raw = np.where(known, raw, low - 2)
    head = struct.pack("<12s4H", b"DIGITAL SURF", 0, objects, 1, kind) + b"tread".ljust(30) + b"rig".ljust(30)
    head += struct.pack("<5H8xH", 0, 0, 0, 1, 1, 32) + struct.pack("<iiiiI", low, high, nx, ny, nx * ny)
    head += struct.pack("<3f", dx * per, dy * per, scale * per) + b"X".ljust(16) + b"Y".ljust(16) + b"Z".ljust(16)
    head += 6 * unit.ljust(16) + struct.pack("<3f3H", 1, 1, 1, 0, 0, 0) + bytes(12)
    head += struct.pack("<7H", 0, 0, 3, 23, 11, 2026, 1) + bytes(4 + 8 + 2) + struct.pack("<2H", len(comment), 0)
    return head.ljust(512, b"\0") + comment + raw.astype("<i4").tobytes()


def al3d(heights, dx, dy, invalid="NaN"):
    """Alicona: tags of 52 bytes, a comment of 256, rows of single precision filled up to 8 bytes."""
    ny, nx = heights.shape
    tags = {
        "Type": "SurfaceDataDepth", "Cols": nx, "Rows": ny, "PixelSizeXMeter": dx, "PixelSizeYMeter": dy,
        "InvalidPixelValue": invalid, "TexturePtr": "0", "IconOffset": 0, "DepthImageOffset": 0,
    }  # fmt: skip
    start = 17 + 52 * (2 + len(tags)) + 256
    tags["DepthImageOffset"] = start

    def tag(key, value):
        return key.encode().ljust(20, b"\0") + str(value).encode().ljust(30, b"\0") + b"\r\n"

    head = b"AliconaImaging\0\r\n" + tag("Version", 1) + tag("TagCount", len(tags))
    head += b"".join(tag(key, value) for key, value in tags.items()) + b"\r\n".rjust(256, b"\0")
    filled = np.zeros((ny, -(-nx // 2) * 2), dtype="<f4")
    filled[:, :nx] = heights if invalid == "NaN" else np.where(np.isnan(heights), float(invalid), heights)
    return head + filled.tobytes()


WRITERS = {
    "double.x3p": x3p,
    "single.x3p": lambda *map: x3p(*map, "F"),
    "long.x3p": lambda *map: x3p(*map, "L"),
    "short.x3p": lambda *map: x3p(*map, "I"),
    "binary.sdf": sdf_binary,
    "text.sdf": sdf_text,
    "map.sur": sur,
    "nan.al3d": al3d,
    "mark.al3d": lambda *map: al3d(*map, "-1e9"),
}
