// A street between shops and houses, cobbled, closed by a tower.
#version 3.7;
#declare SunAzimuth = 215;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"
#include "building.inc"
#include "shop.inc"
#include "plants.inc"

#declare HalfStreet = 5.2;

// A house on the left (Side -1) or right (Side 1), its near corner at Z.
// The wall and the front of each house change with Seed.
#macro House(Side, Z, Width, StatedFloors, StatedColumns, StatedHeight, StatedWall, Trim, Frame, Tint, Shutter, Name,
    Lit, Setback)
    #local Floors = max(2, VariedSteps(StatedFloors, 1));
    #local Columns = max(2, VariedSteps(StatedColumns, 1));
    #local FloorHeight = Varied(StatedHeight, 0.06);
    #local Wall = StatedWall
    #local Paint = <Varied(0.6, 0.4), Varied(0.5, 0.4), Varied(0.4, 0.4)>;
    #switch (VariedSteps(-2, 1) * (Seed > 0))
        #case (-1) #local Wall = BrickTexture(Paint * <0.9, 0.5, 0.4>, Z) #break
        #case (-2) #local Wall = PlasterTexture(Paint * 1.2, Z) #break
        #case (-3) #local Wall = AshlarTexture(Paint, Z) #break
    #end
    union {
        Facade(Width, Floors, Columns, 3.3, FloorHeight, Wall, Trim, Frame, Shutter, Lit)
        Shop(Width, 3.3, Name, Wall, Tint, int(Lit + 0.65))
        // its sides, visible above a lower neighbour
        box { <0, 0, 0.39>, <0.2, 3.3 + Floors * FloorHeight, 9> Surface(WALL, Wall) }
        box { <Width - 0.2, 0, 0.39>, <Width, 3.3 + Floors * FloorHeight, 9> Surface(WALL, Wall) }
        box { <0.19, 0, 1>, <Width - 0.19, 3.2 + Floors * FloorHeight, 9> Surface(WALL, Wall) }
        #if (Side > 0)
            rotate 90 * y translate <HalfStreet + Setback, 0, Z + Width>
        #else
            rotate -90 * y translate <-HalfStreet - Setback, 0, Z>
        #end
    }
#end

#macro StreetLamp(Side, Z)
    #local X = Side * (HalfStreet - 1.9);
    union {
        cone { 0, 0.13, 0.7 * y, 0.07 }
        cylinder { 0.6 * y, 3.9 * y, 0.045 }
        torus { 0.08, 0.03 translate 0.75 * y }
        torus { 0.06, 0.02 translate 3.2 * y }
        cylinder { <-0.35, 3.3, 0>, <0.35, 3.3, 0>, 0.02 }
        cone { 4.42 * y, 0.26, 4.66 * y, 0.03 }
        cone { 3.85 * y, 0.1, 3.95 * y, 0.16 }
        #for (I, 0, 3) cylinder { <0.15, 3.95, 0>, <0.23, 4.42, 0>, 0.014 rotate (45 + 90 * I) * y } #end
        cone { 3.96 * y, 0.13, 4.41 * y, 0.2 no_shadow Surface(LAMP, GlowTexture(<0.8, 0.75, 0.6>, 3.2 * LampsOn * <1, 0.8, 0.5>)) }
        LampLight(4.1 * y, <4.2, 3.0, 1.6>, 2.2)
        Surface(LAMP, MetalTexture(<0.06, 0.09, 0.08>))
        translate <X, 0.12, Z>
    }
#end

#macro Hanging(Side, Z, Name, Tint)
    union {
        cylinder { <0, 0, 0>, <1.1, 0, 0>, 0.02 Surface(SIGN, MetalTexture(0.1)) }
        box { <0.2, -0.75, -0.03>, <1.05, -0.05, 0.03> Surface(SIGN, PaintTexture(Tint, Z)) }
        text { internal 2 Name 0.1, 0 scale <0.3, 0.42, 1> translate <0.28, -0.5, -0.05>
            Surface(SIGN, GlowTexture(<0.9, 0.85, 0.7>, 0.3 * LampsOn)) }
        #if (Side > 0) translate -1.15 * x #end
        translate <Side * HalfStreet, 3.9, Z>
    }
#end

#macro Barrel(X, Z, Size)
    union {
        cone { 0, 0.85 * Size, 0.5 * Size * y, Size }
        cone { 0.5 * Size * y, Size, 2.2 * Size * y, Size }
        torus { Size, 0.04 translate 1.9 * Size * y }
        torus { Size, 0.04 translate 0.6 * Size * y }
        Surface(OBJECT, WoodTexture(<0.35, 0.2, 0.1>, X))
        translate <X, 0.12, Z>
    }
#end

#macro Bicycle(X, Z, Turn, Tint)
    union {
        #for (I, 0, 1)
            union {
                torus { 0.33, 0.02 rotate 90 * x }
                #for (J, 0, 11) cylinder { 0, 0.33 * x, 0.003 rotate 30 * J * z } #end
                translate <1.05 * I, 0.35, 0>
                Surface(OBJECT, MetalTexture(0.05))
            }
        #end
        cylinder { <0, 0.35, 0>, <0.32, 0.85, 0>, 0.018 }
        cylinder { <0.32, 0.85, 0>, <0.9, 0.88, 0>, 0.018 }
        cylinder { <0.42, 0.35, 0>, <0.9, 0.85, 0>, 0.018 }
        cylinder { <0, 0.35, 0>, <0.42, 0.35, 0>, 0.014 }
        cylinder { <0.42, 0.35, 0>, <0.28, 0.98, 0>, 0.016 }
        cylinder { <1.05, 0.35, 0>, <0.88, 1.02, 0>, 0.018 }
        cylinder { <0.88, 1.02, -0.28>, <0.88, 1.02, 0.28>, 0.016 }
        box { <0.16, 0.97, -0.07>, <0.4, 1.02, 0.07> }
        Surface(OBJECT, PaintTexture(Tint, X))
        rotate 6 * x rotate Turn * y translate <X, 0.12, Z>
    }
#end

#macro Bench(X, Z, Turn)
    union {
        #for (I, 0, 3) box { <-0.8, 0.45, -0.22 + 0.12 * I>, <0.8, 0.49, -0.13 + 0.12 * I> } #end
        #for (I, 0, 2) box { <-0.8, 0.58 + 0.14 * I, 0.24>, <0.8, 0.68 + 0.14 * I, 0.28> } #end
        #for (I, 0, 1) box { <-0.7 + 1.3 * I, 0, -0.2>, <-0.62 + 1.3 * I, 0.9, 0.24> } #end
        Surface(FURNITURE, WoodTexture(<0.42, 0.26, 0.12>, X))
        rotate Turn * y translate <X, 0.12, Z>
    }
#end

// A column with posters around it.
#macro PosterColumn(X, Z)
    union {
        cylinder { 0, 2.6 * y, 0.55 Surface(OBJECT, PlasterTexture(<0.55, 0.52, 0.45>, X)) }
        cone { 2.6 * y, 0.68, 3.1 * y, 0.05 Surface(ROOF, MetalTexture(<0.15, 0.25, 0.2>)) }
        #for (I, 0, 8)
            #local Paper = <Any(0.2, 0.9), Any(0.2, 0.8), Any(0.1, 0.7)>;
            #local Ink = <Any(0, 0.4), Any(0, 0.3), Any(0, 0.3)>;
            union {
                intersection { cylinder { 0, y, 0.56 + 0.001 * I } box { <-0.28, 0.02, -1>, <0.28, 0.9, 0> } }
                Surface(SIGN, texture {
                    pigment {
                        gradient y scale Any(0.3, 0.9)
                        pigment_map {
                            [0.35 bozo turbulence 0.4 scale 0.12 translate I color_map { [0.45 rgb Paper] [0.5 rgb Ink] }]
                            [0.4 rgb Paper]
                            [0.5 gradient y scale 0.07 color_map { [0.5 rgb Paper] [0.5 rgb Ink] }]
                            [0.9 cells scale 0.09 color_map { [0 rgb Paper] [1 rgb Ink] }]
                        }
                    }
                })
                rotate 47 * I * y translate (mod(I, 2) * 1.0 + Any(0.25, 0.45)) * y
            }
        #end
        translate <X, 0.12, Z>
    }
#end

#include "street_scene.inc"
FinishOutdoors(Scene)
