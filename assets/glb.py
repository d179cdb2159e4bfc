"""What the scripts beside this one write scenes with: accessors over one buffer view each, and the container."""
import json
import struct


def normal(a, b, c):
    u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = sum(x * x for x in n) ** 0.5
    return tuple(x / length for x in n)


class Glb:
    def __init__(self):
        self.data = bytearray()
        self.gltf = {"accessors": [], "bufferViews": [], "materials": [], "meshes": [], "nodes": []}

    def view(self, data, **more):
        self.gltf["bufferViews"].append(dict(more, buffer=0, byteOffset=len(self.data), byteLength=len(data)))
        self.data += data + b"\0" * (-len(data) % 4)
        return len(self.gltf["bufferViews"]) - 1

    def accessor(self, rows, kind, code, component, target, bounds=False):
        packed = struct.pack("<%d%s" % (len(rows) * len(rows[0]), code), *(x for row in rows for x in row))
        accessor = {"bufferView": self.view(packed, target=target), "componentType": component, "count": len(rows),
                    "type": kind}
        if bounds:  # of the values as stored, which 32-bit rounding moved
            stored = list(zip(*struct.iter_unpack("<3f", packed)))
            accessor["min"], accessor["max"] = [min(x) for x in stored], [max(x) for x in stored]
        self.gltf["accessors"].append(accessor)
        return len(self.gltf["accessors"]) - 1

    def use(self, extension):
        used = self.gltf.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)

    def material(self, name, colour, radiance=0.0, texture=None):
        """Radiance in W m^-2 sr^-1, or three of them, of white light where it is one."""
        base = {"baseColorFactor": list(colour) + [1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0}
        if texture is not None:
            base["baseColorTexture"] = {"index": texture}
        material = {"name": name, "pbrMetallicRoughness": base}
        channels = list(radiance) if isinstance(radiance, tuple) else [radiance] * 3
        if any(channels):
            most = max(channels)
            material["emissiveFactor"] = [channel / most for channel in channels]
            material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": most}}
            self.use("KHR_materials_emissive_strength")
        self.gltf["materials"].append(material)
        return len(self.gltf["materials"]) - 1

    def mesh(self, name, positions, normals, picture, atlas, indices, material):
        """TEXCOORD_0 is `picture`, TEXCOORD_1 `atlas`."""
        uv = self.accessor(atlas, "VEC2", "f", 5126, 34962)
        attributes = {"POSITION": self.accessor(positions, "VEC3", "f", 5126, 34962, bounds=True),
                      "NORMAL": self.accessor(normals, "VEC3", "f", 5126, 34962),
                      "TEXCOORD_0": uv if picture is atlas else self.accessor(picture, "VEC2", "f", 5126, 34962),
                      "TEXCOORD_1": uv}
        triangles = self.accessor([(i,) for i in indices], "SCALAR", "H", 5123, 34963)
        self.gltf["meshes"].append({"name": name, "primitives": [
            {"attributes": attributes, "indices": triangles, "material": material}]})
        return len(self.gltf["meshes"]) - 1

    def node(self, **node):
        self.gltf["nodes"].append(node)
        return len(self.gltf["nodes"]) - 1

    def bytes(self, generator, scene):
        gltf = dict(self.gltf, asset={"version": "2.0", "generator": generator}, scene=0, scenes=[scene],
                    buffers=[{"byteLength": len(self.data)}])
        text = json.dumps(gltf, sort_keys=True, separators=(",", ":")).encode("ascii")
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + 8 + len(self.data)
        return (struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text +
                struct.pack("<I4s", len(self.data), b"BIN\0") + bytes(self.data))
