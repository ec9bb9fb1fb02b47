// For tests: a wall at a known distance, a ball at a known position and a box of known size.
#version 3.7;
#include "common.inc"
#declare SnowOn = 0;

#declare Scene = union {
    plane { z, 10 Surface(WALL, texture { pigment { rgb 0.2 } finish { ambient 0 diffuse 0 emission 1 } }) }
    box { <1, 0.5, 9>, <3, 1.5, 12> Surface(WINDOW, texture { pigment { rgb 0.5 } finish { ambient 0 diffuse 0 emission 1 } }) }
    // rotated and moved, which must not move its depth texture
    union {
        sphere { 0, 0.1 Surface(LAMP, texture { pigment { rgb 1 } finish { ambient 0 diffuse 0 emission 1 } }) }
        rotate 70 * y translate <-2, 1, 6>
    }
}
Finish(Scene)
