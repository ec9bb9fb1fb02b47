// A hall with machines, lit through strips of windows by day and by hanging lamps. Nothing was trained on it.
#version 3.7;
#declare SunAzimuth = 250;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"

#declare Half = 7.5; #declare Deep = 30; #declare High = 6.5;
#declare HallSeed = seed(71 + 100 * Seed);
#macro Any(From, To) (From + (To - From) * rand(HallSeed)) #end
#macro AnyTint(From, To) <Any(From, To), Any(From, To), Any(From, To)> #end

// A machine about 2 m wide: body, doors, dials, pipes, a motor with ribs, a plate.
#macro Machine(X, Z, Turn)
    #local Tint = AnyTint(0.15, 0.6);
    #local W = Any(1.4, 2.4);
    #local H = Any(1.1, 2.2);
    union {
        box { <-W / 2, 0.1, -0.6>, <W / 2, H, 0.6> Surface(OBJECT, PaintTexture(Tint, X + Z)) }
        box { <-W / 2 - 0.1, 0, -0.7>, <W / 2 + 0.1, 0.1, 0.7> Surface(OBJECT, StoneTexture(0.3, Z)) }
        #for (I, 0, 1)
            box { <-W / 2 + 0.08 + I * W / 2, 0.25, -0.63>, <-0.08 + I * W / 2, 0.6 * H, -0.6> Surface(DOOR, PaintTexture(AnyTint(0.6, 1) * Tint, Z + I)) }
            cylinder { <-0.2 + I * W / 2, 0.4 * H, -0.67>, <-0.2 + I * W / 2, 0.55 * H, -0.67>, 0.02 Surface(OBJECT, MetalTexture(0.7)) }
        #end
        #for (I, 0, 5)
            cylinder { <-W / 2 + W * (I + 0.7) / 6.5, Any(0.7, 0.9) * H, -0.65>, <-W / 2 + W * (I + 0.7) / 6.5, Any(0.7, 0.9) * H, -0.6>, Any(0.03, 0.08)
                Surface(SIGN, GlowTexture(AnyTint(0.1, 0.9), AnyTint(0, 1.2) * LampsOn)) }
        #end
        union {
            cylinder { <-0.6, 0, 0>, <0.6, 0, 0>, 0.28 }
            #for (I, 0, 9) cylinder { (-0.55 + 0.12 * I) * x, (-0.51 + 0.12 * I) * x, 0.36 } #end
            cylinder { <0.6, 0, 0>, <0.9, 0, 0>, 0.07 }
            translate <Any(-0.3, 0.3), H + 0.33, 0> Surface(OBJECT, MetalTexture(AnyTint(0.3, 0.7)))
        }
        #for (I, 0, 3)
            #local At = Any(-W / 2, W / 2);
            cylinder { <At, H, 0.3>, <At, High, 0.3>, Any(0.03, 0.09) Surface(OBJECT, PaintTexture(AnyTint(0.1, 0.7), I)) }
        #end
        box { <-0.3, 0.62 * H, -0.62>, <0.3, 0.68 * H, -0.6> Surface(SIGN, texture { pigment { cells scale 0.03 translate X
            color_map { [0.3 rgb 0.8] [0.3 rgb 0.1] } } }) }
        rotate Turn * y translate <X, 0, Z>
    }
#end

#macro Hanging(X, Z)
    union {
        cylinder { <X, High - 1.2, Z>, <X, High, Z>, 0.015 Surface(LAMP, MetalTexture(0.1)) }
        cone { <X, High - 1.5, Z>, 0.4, <X, High - 1.2, Z>, 0.1 open no_shadow Surface(LAMP, GlowTexture(0.7, <4, 3.6, 2.8> * LampsOn)) }
    }
    LampLight(<X, High - 1.6, Z>, <4.5, 4, 3>, 3)
#end

#declare Scene = union {
    box { <-Half, -0.1, -4>, <Half, 0, Deep> Surface(GROUND, texture {
        Dirty(pigment { granite scale 0.7 translate SeedShift color_map { [0 rgb <0.22, 0.24, 0.22>] [1 rgb <0.42, 0.43, 0.4>] } }, 0.6, 3)
        finish { diffuse 0.75 specular 0.15 roughness 0.02 } }) }
    #for (I, 0, 1) box { <-1.65 + 3.2 * I, 0, -4>, <-1.55 + 3.2 * I, 0.004, Deep> Surface(GROUND, PaintTexture(<0.75, 0.6, 0.1>, I)) } #end
    box { <-Half, -0.1, Deep>, <Half, High, Deep + 0.3> Surface(WALL, BrickTexture(<Varied(0.5, 0.3), 0.34, 0.28>, 2)) }
    box { <-Half, -0.1, -4.3>, <Half, High, -4> Surface(WALL, StoneTexture(0.5, 1)) }
    box { <-Half, High, -4>, <Half, High + 0.2, Deep> Surface(CEILING, StoneTexture(<0.5, 0.5, 0.48>, 4)) }
    #for (I, 0, 1)
        #local Side = 2 * I - 1;
        difference {
            box { <Side * Half, -0.1, -4>, <Side * (Half + 0.3), High, Deep> }
            box { <Side * (Half - 0.1), 2.6, -3>, <Side * (Half + 0.4), 4.8, Deep - 1> }
            Surface(WALL, PlasterTexture(<Varied(0.6, 0.2), Varied(0.58, 0.2), 0.5>, I))
        }
        #for (J, 0, 27) box { <Side * (Half + 0.1), 2.6, -3 + 1.2 * J>, <Side * (Half + 0.15), 4.8, -2.94 + 1.2 * J> Surface(WINDOW, MetalTexture(0.3)) } #end
        #for (J, 0, 7)
            box { <Side * (Half - 0.35), 0, 4 * J - 0.15>, <Side * Half, High, 4 * J + 0.15> Surface(OBJECT, PaintTexture(<0.2, 0.3, 0.32>, J)) }
        #end
    #end
    #for (J, 0, 7)
        union {
            box { <-Half, High - 0.15, -0.1>, <Half, High, 0.1> }
            box { <-Half, High - 0.9, -0.06>, <Half, High - 0.8, 0.06> }
            #for (I, 0, 14) cylinder { <-Half + I, High - 0.85, 0>, <-Half + I + 0.5, High - 0.1, 0>, 0.035 } cylinder { <-Half + I + 0.5, High - 0.1, 0>, <-Half + I + 1, High - 0.85, 0>, 0.035 } #end
            translate 4 * J * z Surface(OBJECT, PaintTexture(<0.25, 0.3, 0.3>, J))
        }
    #end
    #for (J, 0, 5) Machine(Any(-5.2, -3.2), 4.5 + 4 * J, Any(-75, -40)) Machine(Any(3.2, 5.2), 5.5 + 4 * J, Any(40, 75)) #end
    #for (J, 0, 5)
        cylinder { <Any(-6.8, -6.2), Any(1.8, 5.4), -4>, <Any(-6.8, -6.2), Any(1.8, 5.4), Deep>, Any(0.05, 0.14) Surface(OBJECT, PaintTexture(AnyTint(0.2, 0.7), J)) }
        cylinder { <Any(6.2, 6.8), Any(1.8, 5.4), -4>, <Any(6.2, 6.8), Any(1.8, 5.4), Deep>, Any(0.05, 0.14) Surface(OBJECT, PaintTexture(AnyTint(0.2, 0.7), J)) }
        box { <0, 0, 0>, <Any(0.4, 0.9), Any(0.3, 0.8), 0.7> rotate Any(-30, 30) * y translate <Any(-2.6, -1.9), 0, 4 + 3.5 * J> Surface(OBJECT, WoodTexture(<0.5, 0.36, 0.2>, J)) }
    #end
    box { <Varied(-1.5, 0.3), 0, Deep - 0.06>, <Varied(1.5, 0.3), 3, Deep> Surface(DOOR, PaintTexture(AnyTint(0.1, 0.5), 1)) }
    text { internal 2 concat("HALLE ", str(mod(3 + Seed, 9), 0, 0)) 0.06, 0 scale 1.1 translate <-2.2, 3.7, Deep - 0.06> Surface(SIGN, PaintTexture(<0.7, 0.1, 0.1>, 1)) }
    #for (J, 0, 3) Hanging(-2.6, 4 + 7 * J) Hanging(2.6, 7 + 7 * J) #end
    plane { y, -1 Surface(GROUND, StoneTexture(0.3, 1)) }
}
#if (Mode = IMAGE)
    SunLight() SkyAndFog()
    #local Sky = DomeLight * (0.6 * Horizon + 0.4 * Zenith);
    #for (I, 0, 1) #for (J, 0, 2)
        light_source { <(2 * I - 1) * (Half + 0.2), 3.8, 3 + 10 * J> rgb 9 * Sky / (0.6 + DomeLight) fade_distance 2.5 fade_power 2 }
    #end #end
    light_source { <0, 3.5, 5> rgb 1.4 * Sky + 0.1 * SunColour + 0.2 * LampsOn * <1, 0.9, 0.7> fade_distance 6 fade_power 1 shadowless }
#end
Finish(Scene)
