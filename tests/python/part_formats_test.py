# SPDX-FileCopyrightText: 2026 The GLIDAR developers
# SPDX-License-Identifier: BSD-3-Clause
"""Parts of models of every format that has nodes, from files written here: names, counts, frames and boxes."""

import sys
import zipfile
from pathlib import Path

import numpy as np

import glidar

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from gltf_files import Gltf  # noqa: E402

SIDE = np.sqrt(0.5)
# The same tree in each format: (name, parent, position, scale, whether it has the triangle (0, 0, 0) (1, 0, 0) (0, 2, 0),
# whether it is turned by 90 degrees about z).
TREE = [
    ("body", None, (0, 0, 1), (1, 1, 1), True, False),
    ("arm", "body", (2, 0, 0), (1, 1, 1), True, True),
    ("mirrored", "body", (0, 3, 0), (-1, 1, 1), True, False),
    ("hook", "body", (0, 0, 5), (1, 1, 1), False, False),
    ("finger", "hook", (1, 0, 0), (2, 2, 2), True, False),
    ("tip", "finger", (0, 1, 0), (1, 1, 1), True, True),
    ("lamp", "body", (9, 9, 9), (1, 1, 1), False, False),
]
CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0]])


def local_matrix(position, scale, turned):
    matrix = np.diag([*scale, 1.0])
    if turned:
        matrix = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) @ matrix
    matrix[:3, 3] = position
    return matrix


def frame_of(world):
    """Its position and orientation without scale: x and y axis of the node, z right-handed."""
    frame = np.eye(4)
    x = world[:3, 0] / np.linalg.norm(world[:3, 0])
    z = np.cross(x, world[:3, 1])
    z /= np.linalg.norm(z)
    frame[:3, :3], frame[:3, 3] = np.stack([x, np.cross(z, x), z], 1), world[:3, 3]
    return frame


def expected_parts():
    """By path: the pose, and the corners of the triangles with those below. Parts without triangles are left out."""
    paths, world, corners = {}, {}, {}
    for name, parent, position, scale, has_mesh, turned in TREE:
        paths[name] = f"{paths[parent]}/{name}" if parent else name
        world[name] = (world[parent] if parent else np.eye(4)) @ local_matrix(position, scale, turned)
        corners[name] = CORNERS @ world[name][:3, :3].T + world[name][:3, 3] if has_mesh else np.zeros((0, 3))
    poses = {name: np.linalg.inv(frame_of(world[parent]) if parent else np.eye(4)) @ frame_of(world[name]) for name, parent, *_ in TREE}
    for name, parent, *_ in reversed(TREE):
        if parent:
            corners[parent] = np.concatenate([corners[parent], corners[name]])
    return {paths[name]: (poses[name], corners[name]) for name, *_ in TREE if len(corners[name])}


def check_tree(parts):
    """Names, counts, poses and boxes."""
    expected = expected_parts()
    assert [part.name for part in parts] == list(expected)
    for part in parts:
        pose, corners = expected[part.name]
        assert part.parent == part.name.rpartition("/")[0]
        assert part.triangles == len(corners) // 3
        np.testing.assert_allclose(part.minimum, corners.min(axis=0), atol=1e-5)
        np.testing.assert_allclose(part.maximum, corners.max(axis=0), atol=1e-5)
        np.testing.assert_allclose(part.pose, pose, atol=1e-5)


def gltf_of(tree):
    made = Gltf()
    made.primitive(CORNERS.tolist(), [0, 1, 2])
    names = [name for name, *_ in tree]
    made.json["nodes"] = []
    for name, _, position, scale, has_mesh, turned in tree:
        node = {"name": name, "translation": position, "scale": scale, **({"mesh": 0} if has_mesh else {})}
        if turned:
            node["rotation"] = [0, 0, SIDE, SIDE]
        children = [names.index(child) for child, parent, *_ in tree if parent == name]
        made.json["nodes"].append({**node, "children": children} if children else node)
    made.json["scenes"] = [{"nodes": [k for k, one in enumerate(tree) if one[1] is None]}]
    return made


FBX_MESH = 'Geometry: {0}, "Geometry::shape", "Mesh" {{ Vertices: *9 {{ a: 0,0,0,1,0,0,0,2,0 }}\nPolygonVertexIndex: *3 {{ a: 0,1,-3 }}\n' \
    "GeometryVersion: 124 }}\n"
FBX_NODE = 'Model: {0}, "Model::{1}", "{2}" {{ Version: 232\nProperties70: {{\n' \
    'P: "Lcl Translation", "Lcl Translation", "", "A",{3[0]},{3[1]},{3[2]}\nP: "Lcl Rotation", "Lcl Rotation", "", "A",0,0,{5}\n' \
    'P: "Lcl Scaling", "Lcl Scaling", "", "A",{4[0]},{4[1]},{4[2]}\n}} }}\n'


def fbx_of(tree):
    numbers = {name: 2000 + k for k, (name, *_) in enumerate(tree)}
    objects, links = "", ""
    for name, parent, position, scale, has_mesh, turned in tree:
        number = numbers[name]
        objects += FBX_NODE.format(number, name, "Mesh" if has_mesh else "Null", position, scale, 90 if turned else 0)
        links += f'C: "OO",{number},{numbers[parent] if parent else 0}\n'
        if has_mesh:
            objects += FBX_MESH.format(number + 1000)
            links += f'C: "OO",{number + 1000},{number}\n'
    return f"""; FBX 7.4.0 project file
FBXHeaderExtension: {{ FBXHeaderVersion: 1003
FBXVersion: 7400 }}
GlobalSettings: {{ Version: 1000
Properties70: {{
P: "UpAxis", "int", "Integer", "",2
P: "UpAxisSign", "int", "Integer", "",1
P: "FrontAxis", "int", "Integer", "",1
P: "FrontAxisSign", "int", "Integer", "",-1
P: "CoordAxis", "int", "Integer", "",0
P: "CoordAxisSign", "int", "Integer", "",1
P: "UnitScaleFactor", "double", "Number", "",100
}} }}
Objects: {{
{objects}}}
Connections: {{
{links}}}
"""


def collada_node(name):
    """With ids that are not the names."""
    _, _, position, scale, has_mesh, turned = next(one for one in TREE if one[0] == name)
    below = "".join(collada_node(child) for child, parent, *_ in TREE if parent == name)
    return (f'<node id="{name}_id" name="{name}"><translate>{" ".join(map(str, position))}</translate>'
            + ("<rotate>0 0 1 90</rotate>" if turned else "") + f'<scale>{" ".join(map(str, scale))}</scale>'
            + ('<instance_geometry url="#g"/>' if has_mesh else "") + below + "</node>")  # fmt: skip


def collada_of(nodes):
    return f"""<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g" name="triangle"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s" name="Scene">{nodes}</visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def write_3mf(path, resources, items):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("3D/3dmodel.model", '<?xml version="1.0"?><model unit="meter" xmlns="http://schemas.microsoft.com/'
                         f'3dmanufacturing/core/2015/02"><resources>{resources}</resources><build>{items}</build></model>')  # fmt: skip
        archive.writestr("_rels/.rels", '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/'
                         'relationships"><Relationship Target="/3D/3dmodel.model" Id="r" '
                         'Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')  # fmt: skip
        archive.writestr("[Content_Types].xml", '<?xml version="1.0"?><Types '
                         'xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>')  # fmt: skip
    return path


MESH_3MF = "<mesh><vertices>" + "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS) + \
    '</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh>'


def parts_of(path, text=None):
    if text is not None:
        path.write_text(text, encoding="utf-8")
    return glidar.list_parts(path, up="z")


def names_of(*arguments):
    return [part.name for part in parts_of(*arguments)]


def test_nodes_of_gltf_are_parts(tmp_path):
    gltf_of(TREE).write(tmp_path / "a.gltf")
    check_tree(parts_of(tmp_path / "a.gltf"))


def test_nodes_of_fbx_are_parts(tmp_path):
    check_tree(parts_of(tmp_path / "a.fbx", fbx_of(TREE)))


def test_nodes_of_collada_are_parts_by_their_names(tmp_path):
    check_tree(parts_of(tmp_path / "a.dae", collada_of(collada_node("body"))))


def test_objects_and_components_of_3mf_are_parts_by_their_names(tmp_path):
    resources = (f'<object id="1" name="left">{MESH_3MF}</object><object id="2">{MESH_3MF}</object>'
                 '<object id="3" name="both"><components><component objectid="1"/>'
                 '<component objectid="2" transform="1 0 0 0 1 0 0 0 1 5 6 7"/></components></object>')  # fmt: skip
    items = ('<item objectid="3" transform="0 1 0 -1 0 0 0 0 1 1 2 3"/><item objectid="1" transform="-1 0 0 0 1 0 0 0 1 4 0 0"/>'
             '<item objectid="1"/>')  # fmt: skip
    parts = parts_of(write_3mf(tmp_path / "a.3mf", resources, items))
    assert [(part.name, part.triangles) for part in parts] == [
        ("both", 2), ("both/left", 1), ("both/Object_2", 1), ("left", 1), ("left_2", 1)]  # fmt: skip
    both, _, second, mirrored, _ = parts
    np.testing.assert_allclose(both.pose, [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-6)
    np.testing.assert_allclose(second.pose[:3, 3], [5, 6, 7], atol=1e-6)
    np.testing.assert_allclose([second.minimum, second.maximum], [[-7, 7, 10], [-5, 8, 10]], atol=1e-5)
    np.testing.assert_allclose([mirrored.minimum, mirrored.maximum], [[3, 0, 0], [4, 2, 0]], atol=1e-6)
    np.testing.assert_allclose(mirrored.pose[:3, :3], np.diag([-1, 1, -1]), atol=1e-6)


def test_copies_of_a_mesh_are_parts_by_their_numbers(tmp_path):
    made = gltf_of([("tree", None, (0, 0, 1), (1, 1, 1), True, False)])
    attributes = {"TRANSLATION": made.accessor([[0, 0, 0], [5, 0, 0], [0, 5, 0]]),
                  "SCALE": made.accessor([[1, 1, 1], [2, 2, 2], [-1, 1, 1]])}  # fmt: skip
    made.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    made.json["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    made.write(tmp_path / "a.gltf")
    parts = parts_of(tmp_path / "a.gltf")
    assert [(part.name, part.triangles) for part in parts] == [("tree", 3), ("tree/1", 1), ("tree/2", 1), ("tree/3", 1)]
    np.testing.assert_allclose([part.pose[:3, 3] for part in parts], [[0, 0, 1], [0, 0, 0], [5, 0, 0], [0, 5, 0]])
    np.testing.assert_allclose([parts[2].minimum, parts[2].maximum], [[5, 0, 1], [7, 4, 1]])
    np.testing.assert_allclose([parts[3].minimum, parts[3].maximum], [[-1, 5, 1], [0, 7, 1]])
    np.testing.assert_allclose(parts[3].pose[:3, :3], np.diag([-1, 1, -1]))


def test_object_ids_of_ply_are_parts(tmp_path):
    vertices = np.concatenate([CORNERS + [10 * k, 0, 0] for k in range(4)])
    faces = [(0, 7), (1, -1), (2, 7), (3, 0)]
    text = (f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty int object_id\nend_header\n")  # fmt: skip
    text += "".join(f"{x:g} {y:g} {z:g}\n" for x, y, z in vertices)
    text += "".join(f"3 {3 * k} {3 * k + 1} {3 * k + 2} {number}\n" for k, number in faces)
    parts = {part.name: part for part in parts_of(tmp_path / "a.ply", text)}
    assert {name: part.triangles for name, part in parts.items()} == {"object_id 7": 2, "object_id -1": 1, "object_id 0": 1}
    np.testing.assert_allclose([parts["object_id 7"].minimum, parts["object_id 7"].maximum], [[0, 0, 0], [21, 2, 0]])
    for part in parts.values():
        np.testing.assert_array_equal(part.pose, np.eye(4))


def square(name, x=0):
    return (name, None, (x, 0, 0), (1, 1, 1), True, False)


def test_names_that_a_file_repeats_get_numbers(tmp_path):
    expected = ["a", "a_2", "a_2_2", "a_3"]
    made = gltf_of([square(str(k)) for k in range(4)])
    for node, name in zip(made.json["nodes"], ["a", "a", "a_2", "a"], strict=True):
        node["name"] = name
    made.write(tmp_path / "a.gltf")
    assert names_of(tmp_path / "a.gltf") == expected
    text = fbx_of([square(f"#{k}") for k in range(4)])
    for k, name in enumerate(["a", "a", "a_2", "a"]):
        text = text.replace(f"Model::#{k}", f"Model::{name}")
    assert names_of(tmp_path / "a.fbx", text) == expected
    nodes = "".join(f'<node id="n{k}" name="{name}"><instance_geometry url="#g"/></node>' for k, name in enumerate(["a", "a", "a_2", "a"]))
    assert names_of(tmp_path / "a.dae", collada_of(nodes)) == expected
    resources = "".join(f'<object id="{k + 1}" name="{name}">{MESH_3MF}</object>' for k, name in enumerate(["a", "a", "a_2", "a"]))
    items = "".join(f'<item objectid="{k + 1}"/>' for k in range(4))
    assert names_of(write_3mf(tmp_path / "a.3mf", resources, items)) == expected


def test_nodes_without_a_name_have_that_of_their_mesh(tmp_path):
    made = gltf_of([square("x"), square("y")])
    made.json["meshes"][0]["name"] = "shape"
    del made.json["nodes"][0]["name"]
    made.json["nodes"][1]["name"] = ""
    made.write(tmp_path / "a.gltf")
    assert names_of(tmp_path / "a.gltf") == ["shape", "shape_2"]
    assert names_of(tmp_path / "a.dae", collada_of('<node><instance_geometry url="#g"/></node>')) == ["g"]  # its id
    resources = f'<object id="5" name="">{MESH_3MF}</object>'
    assert names_of(write_3mf(tmp_path / "a.3mf", resources, '<item objectid="5"/>')) == ["Object_5"]


def test_names_are_printed_without_control_characters_and_select_their_part(tmp_path):
    made = gltf_of([square("a\x1b[31m\nb"), square("plain")])
    made.write(tmp_path / "a.gltf")
    (first, second) = names_of(tmp_path / "a.gltf")
    assert first.isprintable() and second == "plain"
    objects = glidar.Scene().add_parts(tmp_path / "a.gltf", parts={first: {"class": "odd"}})
    assert sorted((one.class_name, one.triangles) for one in objects) == [("odd", 1), ("unlabelled", 1)]
    text = fbx_of([square("x"), square("plain")]).replace("Model::x", "Model::a\x07b")
    assert all(name.isprintable() for name in names_of(tmp_path / "a.fbx", text))


def test_parts_that_are_mirrored_face_outwards(tmp_path):
    """In every format: the front of a mirrored triangle is that of the mirrored surface."""
    gltf_of(TREE).write(tmp_path / "a.gltf")
    (tmp_path / "a.fbx").write_text(fbx_of(TREE))
    (tmp_path / "a.dae").write_text(collada_of(collada_node("body")))
    for name in ("a.gltf", "a.fbx", "a.dae"):
        scene = glidar.Scene()
        for part in scene.add_parts(tmp_path / name, split="parts", up="z"):
            mesh = part.mesh
            a, b, c = (mesh.vertices[mesh.triangles[0, k]] for k in range(3))
            assert np.cross(b - a, c - a)[2] > 0, (name, part.name)
