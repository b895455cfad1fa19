# SPDX-License-Identifier: GPL-3.0-or-later
"""PNG by the published format alone, for tests: an independent reader.

    png.py size FILE                "width height depth channels"
    png.py get FILE column row      the samples of one pixel
    png.py sum FILE                 sum of all samples
    png.py colours FILE             number of different colours
    png.py text FILE keyword        a tEXt chunk
    png.py make FILE width height LEVEL   an image of 8 bits; LEVEL is an expression of x and y
"""
import struct
import sys
import zlib


def read(path):
    data = open(path, "rb").read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG"
    at, head, packed, texts = 8, None, b"", {}
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], "checksum"
        if kind == b"IHDR":
            head = struct.unpack(">IIBBBBB", body)
        elif kind == b"IDAT":
            packed += body
        elif kind == b"tEXt":
            keyword, words = body.split(b"\0", 1)
            texts[keyword.decode()] = words.decode()
        at += 12 + size
    width, height, depth, colour = head[:4]
    channels = {0: 1, 2: 3}[colour]
    step = max(1, depth * channels // 8)
    stride = (width * depth * channels + 7) // 8
    raw, rows, above = zlib.decompress(packed), [], bytes(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        assert kind in (0, 1, 2), "filter type %d" % kind
        for i in range(stride):
            row[i] = (row[i] + (0, row[i - step] if i >= step else 0, above[i])[kind]) & 255
        above = bytes(row)
        if depth == 16:
            rows.append(struct.unpack(">%dH" % (stride // 2), above))
        elif depth == 8:
            rows.append(tuple(above))
        else:
            per = 8 // depth
            rows.append(tuple((above[x // per] >> (8 - depth * (x % per + 1))) & ((1 << depth) - 1) for x in range(width)))
    return width, height, depth, channels, rows, texts


def main(verb, path, *rest):
    if verb == "make":
        from scans import write_png
        level = compile(rest[2], path, "eval")
        rows = [[eval(level, {"x": x, "y": y}) for x in range(int(rest[0]))] for y in range(int(rest[1]))]
        return write_png(path, rows, 8)
    width, height, depth, channels, rows, texts = read(path)
    if verb == "size":
        print(width, height, depth, channels)
    elif verb == "get":
        x, y = map(int, rest)
        print(*rows[y][channels * x:channels * (x + 1)])
    elif verb == "sum":
        print(sum(map(sum, rows)))
    elif verb == "colours":
        print(len({row[channels * x:channels * (x + 1)] for row in rows for x in range(width)}))
    elif verb == "text":
        print(texts[rest[0]])


main(*sys.argv[1:])
