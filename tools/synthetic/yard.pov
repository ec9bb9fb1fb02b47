// A yard of a plant: tanks, racks of pipes, containers, a fence. Nothing was trained on it.
#version 3.7;
#declare SunAzimuth = 225;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"
#include "plants.inc"

#declare YardSeed = seed(61 + 100 * Seed);
#macro Any(From, To) (From + (To - From) * rand(YardSeed)) #end

// Sheets in rings, with rust that runs down.
#macro SheetTexture(Tint, Offset)
    texture {
        Dirty(pigment {
            pigment_pattern { wrinkles turbulence 0.4 octaves 5 scale <0.25, 2.5, 0.25> translate Offset + SeedShift }
            pigment_map { [0.35 granite scale 0.6 translate Offset color_map { [0 rgb 0.75 * Tint] [1 rgb 1.05 * Tint] }]
                [0.75 rgb <0.32, 0.17, 0.09>] }
        }, 0.4, Offset)
        finish { diffuse 0.7 specular 0.2 roughness 0.05 }
    }
#end

#macro Tank(X, Z, Radius, Height)
    #local Tint = <Any(0.45, 0.8), Any(0.45, 0.75), Any(0.4, 0.7)>;
    union {
        cylinder { 0, Height * y, Radius Surface(WALL, SheetTexture(Tint, X + 3 * Z)) }
        cone { Height * y, Radius, (Height + 0.25 * Radius) * y, 0.3 Surface(ROOF, SheetTexture(0.8 * Tint, X)) }
        #for (I, 1, Height / 1.4) torus { Radius, 0.03 translate 1.4 * I * y Surface(WALL, MetalTexture(0.6 * Tint)) } #end
        #for (I, 0, 11)
            cylinder { <Radius * cos(pi * I / 6), Height, Radius * sin(pi * I / 6)>, <Radius * cos(pi * I / 6), Height + 0.9, Radius * sin(pi * I / 6)>, 0.025
                Surface(OBJECT, MetalTexture(<0.6, 0.5, 0.1>)) }
        #end
        torus { Radius, 0.03 translate (Height + 0.9) * y Surface(OBJECT, MetalTexture(<0.6, 0.5, 0.1>)) }
        // a ladder, a flange with its valve, a sign
        union {
            #for (I, 0, 1) cylinder { <-0.22 + 0.44 * I, 0, -0.15>, <-0.22 + 0.44 * I, Height + 1, -0.15>, 0.025 } #end
            #for (I, 1, Height / 0.3) cylinder { <-0.22, 0.3 * I, -0.15>, <0.22, 0.3 * I, -0.15>, 0.015 } #end
            translate -Radius * z rotate Any(-70, 70) * y Surface(OBJECT, MetalTexture(0.45))
        }
        union {
            cylinder { <0, 0.6, 0>, <0, 0.6, -0.7>, 0.14 }
            #for (I, 0, 2) cylinder { <0, 0.6, -0.2 - 0.22 * I>, <0, 0.6, -0.24 - 0.22 * I>, 0.22 } #end
            torus { 0.2, 0.025 rotate 20 * x translate <0, 1.05, -0.45> }
            cylinder { <0, 0.6, -0.45>, <0, 1.05, -0.45>, 0.03 }
            translate -Radius * z rotate Any(-60, 60) * y Surface(OBJECT, PaintTexture(<Any(0.1, 0.6), 0.15, 0.15>, X))
        }
        text { internal 2 concat("T", str(mod(17 + 7 * Seed + int(3 * X), 90) + 9, 0, 0)) 0.06, 0 scale 0.9
            translate <-0.5, Any(0.5, 0.7) * Height, -Radius - 0.03> Surface(SIGN, PaintTexture(<0.1, 0.1, 0.15>, X)) }
        translate <X, 0, Z>
    }
#end

#macro Rack(Z, High, Count)
    union {
        #for (I, -4, 4)
            box { <3.5 * I - 0.1, 0, -0.8>, <3.5 * I + 0.1, High, -0.6> Surface(OBJECT, SheetTexture(<0.4, 0.42, 0.45>, I)) }
            box { <3.5 * I - 0.1, 0, 0.6>, <3.5 * I + 0.1, High, 0.8> Surface(OBJECT, SheetTexture(<0.4, 0.42, 0.45>, I + 5)) }
            box { <3.5 * I - 0.1, High - 0.2, -1>, <3.5 * I + 0.1, High, 1> Surface(OBJECT, SheetTexture(<0.4, 0.42, 0.45>, I + 9)) }
        #end
        #for (J, 0, Count - 1)
            #local R = Any(0.06, 0.2);
            #local Tint = <Any(0.2, 0.8), Any(0.2, 0.7), Any(0.15, 0.6)>;
            union {
                cylinder { <-15, 0, 0>, <15, 0, 0>, R }
                #for (I, 0, 7) #local At = Any(-14, 14); cylinder { At * x, (At + 0.08) * x, 1.5 * R } #end
                #if (mod(J, 2)) #local At = Any(-4, 4); cylinder { At * x, <At, -High, 0>, R } sphere { At * x, R } #end
                translate <0, High + R, -0.8 + 1.6 * J / Count>
                Surface(OBJECT, SheetTexture(Tint, 7 * J))
            }
        #end
        translate Z * z
    }
#end

#macro Container(X, Z, Turn)
    #local Tint = <Any(0.1, 0.6), Any(0.1, 0.4), Any(0.1, 0.5)>;
    union {
        box { <-1.2, 0.1, 0>, <1.2, 2.6, 6> }
        #for (I, 0, 11) box { <-1.26, 0.3, 0.3 + 0.48 * I>, <1.26, 2.4, 0.5 + 0.48 * I> } #end
        #for (I, 0, 3) box { <-1 + 0.6 * I, 0.2, -0.06>, <-0.85 + 0.6 * I, 2.5, 0> } #end
        Surface(OBJECT, SheetTexture(Tint, X + Z))
        rotate Turn * y translate <X, 0, Z>
    }
#end

#macro Mast(X, Z)
    union {
        cylinder { 0, 6.5 * y, 0.09 Surface(LAMP, MetalTexture(0.35)) }
        box { <-0.35, 6.4, -0.6>, <0.35, 6.55, 0> Surface(LAMP, MetalTexture(0.3)) }
        box { <-0.3, 6.36, -0.55>, <0.3, 6.4, -0.05> no_shadow Surface(LAMP, GlowTexture(0.8, <5, 4.4, 3> * LampsOn)) }
        LampLight(<0, 6.2, -0.4>, <6, 4.8, 3>, 4) translate <X, 0, Z>
    }
#end

#declare Scene = union {
    plane { y, 0 Surface(GROUND, PuddledTexture(texture {
        Dirty(pigment { granite scale 0.25 translate SeedShift
            color_map { [0 rgb <0.16, 0.15, 0.14>] [0.5 rgb <0.3, 0.29, 0.27>] [1 rgb <0.5, 0.48, 0.44>] } }, 0.5, 2)
        normal { granite 0.5 scale 0.06 } GroundFinish(0.4) })) }
    box { <-2, 0, -5>, <1.8, 0.012, 60> Surface(PAVEMENT, AshlarTexture(<0.36, 0.35, 0.34>, 3)) }
    Tank(Varied(-5.5, 0.1), 11, Varied(2.4, 0.15), Varied(5, 0.2)) Tank(Varied(-6.5, 0.1), 19, Varied(3, 0.15), Varied(7, 0.2))
    Tank(Varied(6, 0.1), 15, Varied(2.6, 0.15), Varied(6, 0.2)) Tank(Varied(7.5, 0.1), 24, Varied(3.4, 0.1), Varied(8, 0.2))
    Rack(Varied(17, 0.08), Varied(4.4, 0.08), 7) Rack(29, Varied(5.6, 0.1), 6)
    Container(Varied(3.6, 0.1), 8.5, Varied(-12, 0.6)) Container(Varied(-9.5, 0.1), 8, Varied(35, 0.3))
    Container(Varied(-2, 0.4), 27, 80)
    Mast(-2.8, Varied(9, 0.1)) Mast(2.9, Varied(14.5, 0.1)) Mast(-3, Varied(23, 0.05))
    #for (I, 0, 9)
        cylinder { 0, 0.9 * y, 0.3 translate <Any(-4.4, -2.6), 0, Any(7, 16)> Surface(OBJECT, SheetTexture(<Any(0.1, 0.5), Any(0.1, 0.4), Any(0.2, 0.6)>, I)) }
    #end
    // a hall at the back, and a fence
    box { <-26, 0, 38>, <26, Varied(10, 0.2), 50> Surface(WALL, BrickTexture(<0.5, 0.3, 0.22>, 5)) }
    #for (I, 0, 11) box { <-24 + 4 * I, 3, 37.9>, <-21.6 + 4 * I, 5, 38> Surface(WINDOW, GlowTexture(<0.15, 0.17, 0.2>, <1.6, 1.3, 0.7> * LampsOn * (rand(YardSeed) < 0.4))) } #end
    #for (I, 0, 13)
        cylinder { <-10.5, 0, 3 + 2.5 * I>, <-10.5, 2, 3 + 2.5 * I>, 0.04 Surface(OBJECT, MetalTexture(0.4)) }
        cylinder { <11.5, 0, 3 + 2.5 * I>, <11.5, 2, 3 + 2.5 * I>, 0.04 Surface(OBJECT, MetalTexture(0.4)) }
    #end
    #for (I, 0, 5)
        cylinder { <-10.5, 0.35 * I + 0.2, 2>, <-10.5, 0.35 * I + 0.2, 36>, 0.012 Surface(OBJECT, MetalTexture(0.5)) }
        cylinder { <11.5, 0.35 * I + 0.2, 2>, <11.5, 0.35 * I + 0.2, 36>, 0.012 Surface(OBJECT, MetalTexture(0.5)) }
        object { Bush(Grown(0.3, 0.5), <Grown(0.1, 0.2), 0.24, 0.06>) translate <-10 + Grown(-0.3, 0.3), 0.1, 6 + 3 * I> }
    #end
}
FinishOutdoors(Scene)
