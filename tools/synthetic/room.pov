// A living room: books, pictures, a table, a window in the left wall through which the light comes.
#version 3.7;
#declare SunAzimuth = 300;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"
#include "plants.inc"

#declare HalfWidth = 2.6; #declare Deep = 6.2; #declare High = 2.75;
#declare RoomSeed = seed(41 + 100 * Seed);
#macro Any(From, To) (From + (To - From) * rand(RoomSeed)) #end
#macro AnyTint(From, To) <Any(From, To), Any(From, To), Any(From, To)> #end

#macro Books(Width, Most)
    #local At = 0.01;
    #while (At < Width - 0.06)
        #local Thick = Any(0.018, 0.055);
        #local Tall = Any(0.6, 1) * Most;
        #local Tint = AnyTint(0.03, 0.4) * <1.2, 0.8, 0.6>;
        #local Band = AnyTint(0.2, 0.7) * <1.2, 1, 0.6>;
        #if (rand(RoomSeed) < 0.93)
            box {
                <0, 0, 0>, <Thick - 0.002, Tall, 0.18>
                Surface(OBJECT, texture {
                    pigment {
                        gradient y scale Tall
                        color_map {
                            [0.10 rgb Tint] [0.10 rgb Band] [0.14 rgb Band] [0.14 rgb Tint]
                            [0.55 rgb 0.8 * Tint] [0.55 rgb Band] [0.75 rgb 0.8 * Band] [0.75 rgb Tint]
                            [0.9 rgb Tint]
                            [0.9 rgb Band] [0.92 rgb Band] [0.92 rgb Tint]
                        }
                    }
                    finish { specular 0.15 roughness 0.05 }
                })
                rotate -Any(0, 5) * int(Any(0, 1.25)) * z
                translate <At, 0, Any(0, 0.05)>
            }
        #end
        #local At = At + Thick;
    #end
#end

#macro Bookcase(Wide, Shelves)
    union {
        box { <0, 0, 0>, <0.03, 0.34 * Shelves + 0.08, 0.3> }
        box { <Wide - 0.03, 0, 0>, <Wide, 0.34 * Shelves + 0.08, 0.3> }
        box { <0, 0, 0.28>, <Wide, 0.34 * Shelves + 0.08, 0.3> }
        #for (I, 0, Shelves) box { <0, 0.34 * I + 0.04, 0>, <Wide, 0.34 * I + 0.065, 0.3> } #end
        Surface(FURNITURE, WoodTexture(<0.36, 0.20, 0.10>, Wide))
    }
    #for (I, 0, Shelves - 1)
        #local From = int(Any(0, 1.4)) * 0.35;
        union { Books(Wide - 0.08 - From, 0.27) translate <0.04 + From, 0.34 * I + 0.066, 0.04> }
        #if (From > 0) sphere { <0.2, 0.34 * I + 0.16, 0.12>, 0.09 Surface(OBJECT, StoneTexture(AnyTint(0.2, 0.8), I)) } #end
    #end
#end

#macro Picture(X, Y, Wide, Tall, Kind)
    union {
        difference {
            box { <-Wide / 2 - 0.05, -Tall / 2 - 0.05, -0.04>, <Wide / 2 + 0.05, Tall / 2 + 0.05, 0> }
            box { <-Wide / 2, -Tall / 2, -0.1>, <Wide / 2, Tall / 2, -0.02> }
            Surface(OBJECT, WoodTexture(AnyTint(0.15, 0.5), X))
        }
        box {
            <-Wide / 2, -Tall / 2, -0.021>, <Wide / 2, Tall / 2, -0.015>
            Surface(SIGN, texture {
                #local A = AnyTint(0.1, 0.9);
                #local B = AnyTint(0.02, 0.5);
                #local C = AnyTint(0.3, 0.95);
                pigment {
                    #switch (mod(Kind + Seed, 4))
                        #case (0) gradient y turbulence 0.25 scale 1.3 * Tall translate -0.65 * Tall * y #break
                        #case (1) crackle scale 0.12 translate X #break
                        #case (2) bozo turbulence 0.8 scale 0.15 translate X #break
                        #case (3) leopard turbulence 0.3 scale 0.03 #break
                    #end
                    color_map { [0.1 rgb A] [0.3 rgb B] [0.35 rgb C] [0.5 rgb A] [0.6 rgb C] [0.62 rgb B] [0.9 rgb C] }
                }
            })
        }
        rotate Any(-1.5, 1.5) * z
        translate <X, Y + Varied(0.12, 1) - 0.12, Deep>
    }
#end

#macro Chair(X, Z, Turn)
    union {
        box { <-0.21, 0.43, -0.21>, <0.21, 0.47, 0.21> }
        #for (I, 0, 1) #for (J, 0, 1)
            cylinder { <-0.18 + 0.36 * I, 0, -0.18 + 0.36 * J>, <-0.18 + 0.36 * I, 0.43 + 0.5 * J, -0.18 + 0.4 * J>, 0.02 }
        #end #end
        #for (I, 0, 3) box { <-0.19, 0.58 + 0.09 * I, 0.19>, <0.19, 0.63 + 0.09 * I, 0.215> } #end
        Surface(FURNITURE, WoodTexture(<0.45, 0.28, 0.14>, X))
        rotate Turn * y translate <X, 0, Z>
    }
#end

#macro Cup(X, Y, Z, Tint)
    union {
        difference { cone { 0, 0.03, 0.09 * y, 0.042 } cone { 0.005 * y, 0.026, 0.1 * y, 0.04 } }
        torus { 0.025, 0.006 rotate 90 * x translate <0.05, 0.045, 0> }
        Surface(OBJECT, PaintTexture(Tint, X)) translate <X, Y, Z>
    }
#end

#macro ShadeLamp(At, Size, Brightness)
    union {
        cone {
            0, 0.6 * Size, 0.9 * Size * y, 0.35 * Size open no_shadow
            Surface(LAMP, texture {
                pigment { radial frequency 24 color_map { [0 rgb <0.8, 0.65, 0.4>] [1 rgb <0.6, 0.45, 0.25>] } }
                finish { emission LampsOn * <1.6, 1.3, 0.8> }
            })
        }
        sphere { 0.4 * Size * y, 0.04 no_shadow Surface(LAMP, GlowTexture(0.8, 6 * LampsOn)) }
        translate At
    }
    #if (LampsOn > 0 & Mode = IMAGE)
        light_source {
            At + 0.35 * Size * y rgb LampsOn * Brightness * <1, 0.74, 0.44> fade_distance 0.9 fade_power 2
            area_light 0.2 * x, 0.2 * z, 3, 3 adaptive 1 circular orient
        }
    #end
#end

#include "room_scene.inc"
#if (Mode = IMAGE)
    SunLight()
    SkyAndFog()
    // the sky through the window, and the reflection of walls and floor
    #local Sky = DomeLight * (0.6 * Horizon + 0.4 * Zenith);
    light_source {
        <-HalfWidth - 0.35, 1.65, 3.1> rgb 15 * Sky / (0.6 + DomeLight) fade_distance 1.2 fade_power 2
        area_light 2.2 * z, 1.4 * y, 4, 4 adaptive 1
    }
    light_source {
        <-0.8, 1.3, 2.4> rgb 0.8 * Sky + 0.08 * SunColour + 0.14 * LampsOn * <1, 0.8, 0.55>
        fade_distance 3 fade_power 1 shadowless
    }
    // the reflection of the sunlit patch on floor or wall
    light_source {
        <-1.5 + 2.4 * (SunHeight < 30), 0.3, 2.6> rgb 0.9 * SunColour fade_distance 1.4 fade_power 1
        area_light 0.8 * x, 0.8 * z, 3, 3 adaptive 1
    }
#end
Finish(Scene)
