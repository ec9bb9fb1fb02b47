// A valley with a path: rock, grass, trees, a pond, a fence and a hut.
#version 3.7;
#declare SunAzimuth = 150;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"
#include "plants.inc"

// Height field of 200 m x 200 m in front of the camera, made by a pattern; the path along x = 0 is level.
#declare Side = 200;
#declare Rise = 46;
#declare Rough = function { pigment { granite scale 1.1 translate <3.3, 1.7, 5.1> + SeedShift color_map { [0 rgb 0] [1 rgb 1] } } }
#declare Folds = function { pigment { bozo scale 0.22 translate <8, 1, 2> + SeedShift color_map { [0 rgb 0] [1 rgb 1] } } }
#declare Steps = function { pigment { wrinkles scale 0.07 translate 4.4 + SeedShift color_map { [0 rgb 0] [1 rgb 1] } } }
#declare Valley = function(u, v) {
    min(1, 0.9 * pow(min(1, max(0, abs(u - 0.5 - 0.02 * sin(9 * v - 0.4)) - 0.012) * 3.2), 1.5) + 0.55 * pow(v, 3))
}
#declare Height = function(u, v) {
    Valley(u, v) * (0.30 + 0.45 * Folds(u, v, 0).red + 0.20 * Rough(u, v, 0).red + 0.09 * Steps(u, v, 0).red)
    + 0.003 * Steps(3 * u, 3 * v, 0).red
}

#declare Offset = <-Side / 2, 0, -6>;
#declare Land = height_field { function 500, 500 { Height(x, 1 - y) } smooth scale <Side, Rise, Side> translate Offset }

#macro PathAt(Z) (4 * sin(0.045 * (Z + 6) - 0.4)) #end
// The ground under (X, Z): its point and its normal.
#declare Upward = <0, 0, 0>;
#macro Under(X, Z) trace(Land, <X, 100, Z>, -y, Upward) #end

#declare Grass = texture {
    pigment {
        pigment_pattern { bozo turbulence 0.6 scale 5 translate SeedShift }
        pigment_map {
            [0.3 granite scale 0.8 color_map { [0 rgb <0.05, 0.08, 0.02>] [0.5 rgb <0.16, 0.23, 0.06>] [1 rgb <0.33, 0.33, 0.13>] }]
            [0.7 granite scale 0.5 color_map { [0 rgb <0.09, 0.08, 0.03>] [0.5 rgb <0.30, 0.27, 0.11>] [1 rgb <0.45, 0.40, 0.20>] }]
        }
    }
    normal { granite 1.0 scale 0.4 }
}
#declare Cliff = texture {
    pigment {
        pigment_pattern { gradient y turbulence 0.25 octaves 4 translate SeedShift scale <6, 2.3, 6> rotate 8 * z }
        pigment_map {
            [0 granite scale 2 color_map { [0 rgb <0.16, 0.14, 0.12>] [1 rgb <0.50, 0.46, 0.40>] }]
            [0.5 granite scale 1 color_map { [0 rgb <0.30, 0.25, 0.20>] [1 rgb <0.62, 0.56, 0.47>] }]
            [1 granite scale 1.5 color_map { [0 rgb <0.12, 0.12, 0.11>] [1 rgb <0.42, 0.40, 0.37>] }]
        }
    }
    normal { granite 1.2 scale 2 }
}
#declare Gravel = texture {
    pigment {
        crackle solid scale 0.09 translate SeedShift
        color_map { [0 rgb <0.20, 0.16, 0.12>] [0.5 rgb <0.45, 0.38, 0.29>] [1 rgb <0.65, 0.58, 0.48>] }
    }
    normal { granite 0.8 scale 0.2 }
    GroundFinish(0.3)
}
// A winding path in the grass; rock on steep slopes.
#declare Ground = texture {
    pigment_pattern {
        function { max(0, 1 - abs(x - 4 * sin(0.045 * (z + 6) - 0.4) - 0.3 * sin(0.9 * z)) / 3) }
        color_map { [0 rgb 0] [1 rgb 1] }
    }
    texture_map { [0.44 slope { y } texture_map { [0.80 Cliff] [0.87 Grass] }] [0.56 Gravel] }
}

// A boulder of radius 1: a deformed ball, as a mesh.
#declare Bumpy = function { pigment { granite scale 2.6 color_map { [0 rgb 0] [1 rgb 1] } } }
#macro Boulder(Seed)
    #local N = 14;
    #local Points = array[2 * N + 1][N + 1];
    #for (I, 0, 2 * N)
        #for (J, 0, N)
            #local P = vrotate(y, <180 * J / N, 0, 0>);
            #local P = vrotate(P, 360 * mod(I, 2 * N) / (2 * N) * y);
            #local Points[I][J] = P * (0.55 + 0.8 * Bumpy(P.x + Seed, P.y, P.z).red);
        #end
    #end
    mesh {
        #for (I, 0, 2 * N - 1)
            #for (J, 0, N - 1)
                #if (J > 0) triangle { Points[I][J], Points[I + 1][J], Points[I][J + 1] } #end
                #if (J < N - 1) triangle { Points[I + 1][J], Points[I + 1][J + 1], Points[I][J + 1] } #end
            #end
        #end
    }
#end

#macro Fir(High, Tint)
    union {
        cone { -0.5 * y, 0.03 * High, High * y, 0.01 Surface(WOOD, BarkTexture(High)) }
        object { Needles Surface(PLANT, LeafTexture(Tint)) scale <High * 0.24, High, High * 0.24> rotate Grown(0, 360) * y }
    }
#end

// The branches of a fir of height 1 and radius 1.
#declare Needles = mesh {
    #for (I, 0, 420)
        #local At = 0.1 + 0.9 * pow(I / 420, 0.8);
        #local Turn = I * 137.508;
        #for (J, 0, 7)
            #local Reach = (1 - At) * Grown(0.35, 1.05);
            #local P = vrotate(<Reach, At - 0.12 * Reach, 0>, (Turn + Grown(-14, 14)) * y);
            #local Q = vrotate(<0.10, -0.03, 0.05>, Grown(0, 360) * y);
            triangle { P, P + Q, P + <-Q.z * 0.5, 0.012, Q.x * 0.5> }
        #end
    #end
}

// A square metre of grass.
#declare Tuft = mesh {
    #for (I, 0, 500)
        #local At = <Grown(-0.5, 0.5), -0.02, Grown(-0.5, 0.5)>;
        #local Tip = <Grown(-0.12, 0.12), Grown(0.08, 0.34), Grown(-0.12, 0.12)>;
        #local Wide = vrotate(0.008 * x, Grown(0, 180) * y);
        triangle { At - Wide, At + Wide, At + Tip }
    #end
}

#include "terrain_scene.inc"
FinishOutdoors(Scene)
