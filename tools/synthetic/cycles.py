"""Renders views by Blender's Cycles, another renderer than the scenes' POV-Ray, in views.py's layout:
blender --background --python cycles.py -- FOLDER [--seed N ...] [--size WIDTH HEIGHT]. See README.md."""
import argparse
import pathlib
import random
import sys

import bpy
import cv2
import mathutils
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from localization import SIZE
from render import DEPTH_SCALE, sensed, write, write_text
from scenes import LIGHTS, SCENES, Scene, cameras, extrinsics, intrinsics, tum, walk
from views import BESIDE, MAP_VIEWS, VIEWS

SAMPLES = 12  # rays a pixel; the remaining noise serves as a sensor's
# Sun: degrees of azimuth and altitude, strength, tint; strength and tint of the sky; of the lamps.
SUN = {"noon": (215, 55, 4, (1, .95, .86), 1.0, (.55, .7, 1), 0), "overcast": (215, 60, 0, (1, 1, 1), 1.3, (.8, .85, .9), 0),
       "dusk": (40, 6, 1.4, (1, .5, .25), .22, (.6, .5, .6), .3), "night": (160, 40, .03, (.6, .75, 1), .012, (.4, .5, 1), 1)}
PLACE = "court"
SCENES[PLACE] = Scene(1.0, None, [(-0.8, 1.7, 0, -5, 4), (0.5, 1.7, 2, 6, 5), (-0.4, 1.75, 4, -8, 4), (0.6, 1.7, 6, 4, 5)], [])


def material(chance):
    """Stone, bricks, planks or paint: detail at several scales, in two tints."""
    made = bpy.data.materials.new("m")
    made.use_nodes = True
    nodes, link = made.node_tree.nodes, made.node_tree.links.new
    place = nodes.new("ShaderNodeNewGeometry").outputs["Position"]
    grey = chance.uniform(.15, .7)
    tint = [grey * chance.uniform(.7, 1.3) for _ in range(3)]
    other = [value * chance.uniform(.3, .7) for value in tint]
    kind = chance.choice(("brick", "noise", "voronoi", "wave"))
    base = nodes.new("ShaderNodeTex" + kind.capitalize())
    base.inputs["Scale"].default_value = chance.uniform(2, 6)
    fine = nodes.new("ShaderNodeTexNoise")
    fine.inputs["Scale"].default_value, fine.inputs["Detail"].default_value = chance.uniform(4, 9), 12
    link(place, base.inputs["Vector"])
    link(place, fine.inputs["Vector"])
    factor = nodes.new("ShaderNodeMath")
    factor.operation = "MULTIPLY_ADD"
    link(base.outputs.get("Fac") or base.outputs["Distance"], factor.inputs[0])
    factor.inputs[1].default_value = .6
    link(fine.outputs["Fac"], factor.inputs[2])
    ramp = nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[1].position = .45, .95
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (*other, 1), (*tint, 1)
    link(factor.outputs[0], ramp.inputs["Fac"])
    surface = nodes["Principled BSDF"]
    link(ramp.outputs["Color"], surface.inputs["Base Color"])
    surface.inputs["Roughness"].default_value = chance.uniform(.5, .95)
    return made


def box(chance, at, size, turn=0.):
    bpy.ops.mesh.primitive_cube_add(size=1, location=at, rotation=(0, 0, turn), scale=size)
    bpy.context.object.data.materials.append(material(chance))


def cylinder(chance, at, radius, high, lying=False):
    bpy.ops.mesh.primitive_cylinder_add(radius=radius, depth=high, location=at, rotation=(np.pi / 2 if lying else 0, 0, 0))
    bpy.context.object.data.materials.append(material(chance))


def lamp(at, strength):
    if strength:
        bpy.ops.object.light_add(type="POINT", location=at)
        bpy.context.object.data.energy, bpy.context.object.data.color = 350 * strength, (1, .8, .5)
        bpy.context.object.data.shadow_soft_size = .15


def build(name, seed, light):
    """x right, y forward, z up: a court between walls with tanks and boxes."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    chance = random.Random("%s %d" % (name, seed))
    azimuth, altitude, sun, tint, sky, above, lamps = SUN[light]
    half, deep, high = 9, 30, 7
    box(chance, (0, deep / 2, -.1), (2.4 * half, 2 * deep, .2))
    for side in (-1, 1):
        for k in range(5):
            box(chance, (side * (half + chance.uniform(.5, 1.5)), deep * (k + .3) / 5, high / 2), (2, deep / 5, high * chance.uniform(.7, 1.2)))
            if k:
                radius, tall = chance.uniform(.7, 1.8), chance.uniform(2, 6)
                cylinder(chance, (side * chance.uniform(4, 6), deep * k / 5, tall / 2), radius, tall)
            cylinder(chance, (side * chance.uniform(.5, .8) * half, deep / 2, chance.uniform(3, high)), chance.uniform(.05, .2), deep, True)
            lamp((side * half * .35, deep * (k + .4) / 5, high * .75), lamps)
    box(chance, (0, deep, high / 2), (2 * half, .5, high))
    for _ in range(14):
        size = [chance.uniform(.3, 1.2) for _ in range(3)]
        at = chance.choice((-1, 1)) * chance.uniform(1.6, 3.2), chance.uniform(4, deep - 2), size[2] / 2
        box(chance, at, size, chance.uniform(-.6, .6))
    if sun:
        bpy.ops.object.light_add(type="SUN", rotation=(np.radians(90 - altitude), 0, np.radians(180 - azimuth)))
        bpy.context.object.data.energy, bpy.context.object.data.color, bpy.context.object.data.angle = sun, tint, .02
    bpy.context.scene.world = bpy.data.worlds.new("sky")
    bpy.context.scene.world.use_nodes = True
    background = bpy.context.scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (*above, 1), sky


def look(pose, focal, size):
    """A camera as in scenes.py; the scene files' x, y up, z forward are Blender's x, z, y."""
    to_camera = extrinsics(pose)[:, :3] * [1, -1, 1]  # of x right, y up, z forward; its rows: right, down, forward
    right, down, forward = to_camera[:, [0, 2, 1]]
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([right, -down, -forward, np.array(pose)[[0, 2, 1]]])
    scene = bpy.context.scene
    bpy.ops.object.camera_add()
    scene.camera = bpy.context.object
    scene.camera.matrix_world = mathutils.Matrix(matrix)
    scene.camera.data.sensor_width, scene.camera.data.lens = 36, 36 * focal  # millimetres; a lens has one at least
    scene.render.resolution_x, scene.render.resolution_y = size
    return matrix


def depth(matrix, camera, size):
    """Metres along the axis through each pixel's centre; 0 where there is nothing."""
    found, graph = np.zeros(size[::-1]), bpy.context.evaluated_depsgraph_get()
    scene, origin = bpy.context.scene, mathutils.Vector(matrix[:3, 3])
    for y in range(size[1]):
        for x in range(size[0]):
            ray = matrix[:3, :3] @ [(x - camera[0, 2]) / camera[0, 0], -(y - camera[1, 2]) / camera[1, 1], -1]
            hit, at, *_ = scene.ray_cast(graph, origin, mathutils.Vector(ray))
            found[y, x] = -(np.array(at) - matrix[:3, 3]) @ matrix[:3, 2] if hit else 0
    return np.minimum(np.rint(found / DEPTH_SCALE), 65535).astype(np.uint16)


def render(name, seed, light, pose, frame, target, size):
    beside = target.parents[1] / "depth" / target.name
    if target.exists() and beside.exists():
        return
    build(name, seed, light)
    matrix = look(pose, SCENES[name].focal, size)
    if not beside.exists():
        write(beside, depth(matrix, intrinsics(name, *size), size))
    if target.exists():
        return
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples, scene.cycles.seed = "CYCLES", SAMPLES, frame
    scene.cycles.max_bounces, scene.cycles.use_denoising = 3, False
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.exposure = {"dusk": 1, "night": .8}.get(light, 0)
    scene.render.filepath = str(target.with_name("." + target.name))
    bpy.ops.render.render(write_still=True)
    picture = cv2.imread(scene.render.filepath)
    pathlib.Path(scene.render.filepath).unlink()
    write(target, sensed(picture, name, light, frame))
    print(target, flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--seed", nargs="+", type=int, default=[71])
    parser.add_argument("--size", type=int, nargs=2, default=SIZE)
    options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
    for seed in options.seed:
        for light in SUN:
            random = np.random.default_rng([seed, LIGHTS[light]])
            poses = walk(SCENES[PLACE].path, MAP_VIEWS if light == "noon" else 100)
            if light != "noon":
                poses = poses[np.sort(random.choice(100, VIEWS, replace=False))]
                poses[:, [0, 1, 3, 4]] += random.uniform(-1, 1, (VIEWS, 4)) * BESIDE
            folder = options.out / f"{PLACE}_{seed}" / ("map" if light == "noon" else light)
            names = [f"{k:04d}" for k in range(len(poses))]
            write_text(folder / "cameras.txt", cameras(PLACE, tuple(options.size)))
            write_text(folder / "poses.txt", tum(names, poses))
            for k, pose in enumerate(poses):
                render(PLACE, seed, light, pose, k, folder / "images" / f"{names[k]}.png", tuple(options.size))


main()
