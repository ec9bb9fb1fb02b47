// The front of a block of flats: one repeated bay, with objects of the residents that distinguish places.
#version 3.7;
#declare SunAzimuth = 230;
#include "common.inc"
#include "lights.inc"
#include "materials.inc"
#include "building.inc"
#include "plants.inc"

#declare Bay = Varied(3.4, 0.12);
#declare Storey = Varied(2.9, 0.06);
#declare Bays = 11; #declare Storeys = 6; #declare FrontAt = 17;
#declare White = <0.80, 0.79, 0.76>;
#declare Panel = <Varied(0.60, 0.3), Varied(0.57, 0.3), Varied(0.51, 0.3)>;

#macro Washing(Width)
    cylinder { <0, 1.75, -0.9>, <Width, 1.75, -0.9>, 0.006 Surface(OBJECT, MetalTexture(0.5)) }
    #local At = Any(0.1, 0.5);
    #while (At < Width - 0.5)
        #local Wide = Any(0.25, 0.55);
        #local Tint = <Any(0.1, 0.9), Any(0.1, 0.9), Any(0.1, 0.9)>;
        box {
            <At, 1.75 - Any(0.4, 0.8), -0.91>, <At + Wide, 1.75, -0.89>
            Surface(CLOTH, texture {
                pigment { gradient x + Any(0, 1) * y scale Any(0.04, 0.2) color_map { [0.5 rgb Tint] [0.6 rgb 0.6 * Tint + 0.2] } }
            })
        }
        #local At = At + Wide + Any(0.05, 0.4);
    #end
#end

#macro Dish()
    union {
        difference { sphere { 0, 0.42 } sphere { <0, 0, -0.12>, 0.44 } }
        cylinder { 0, <0, -0.1, -0.45>, 0.012 }
        cylinder { 0, <0, -0.4, 0.3>, 0.02 }
        rotate <-20, Any(-40, 40), 0>
        Surface(OBJECT, MetalTexture(<0.65, 0.65, 0.62>))
    }
#end

#macro Balcony(Width, Tint)
    union {
        box { <0, -0.12, -1.1>, <Width, 0, 0.1> Surface(WALL, StoneTexture(<0.45, 0.44, 0.42>, Any(0, 9))) }
        box {
            <0.02, 0.06, -1.1>, <Width - 0.02, 0.82, -1.07>
            Surface(OBJECT, texture {
                Dirty(pigment { gradient x scale 0.11 color_map { [0.85 rgb Tint] [0.9 rgb 0.35 * Tint] } }, 0.6, Any(0, 9))
            })
        }
        cylinder { <0, 0.98, -1.085>, <Width, 0.98, -1.085>, 0.025 Surface(OBJECT, MetalTexture(0.4)) }
        #for (I, 0, 3) cylinder { <Width * I / 3, 0, -1.085>, <Width * I / 3, 0.98, -1.085>, 0.018 Surface(OBJECT, MetalTexture(0.4)) } #end
        #local Kind = rand(BuildingSeed);
        #if (Kind < 0.3) Washing(Width) #end
        #if (Kind > 0.22 & Kind < 0.5) object { Dish() translate <Any(0.4, Width - 0.4), 1.2, -1.1> } #end
        #if (Kind > 0.45 & Kind < 0.8) object { Flowers(Width * 0.6) translate <Any(0, 0.8), 0.82, -0.9> } #end
        #if (Kind > 0.7)
            #for (I, 0, 2) object { Bush(Any(0.2, 0.4), <0.12, 0.3, 0.08>) translate <Any(0.3, Width - 0.3), 0.5, -0.7> } #end
        #end
        #if (Kind > 0.85)
            box { <0.05, 2.1, -1.1>, <Width - 0.05, 2.13, 0>
                  Surface(CLOTH, texture { pigment { gradient x scale 0.3 color_map { [0.5 rgb 0.8] [0.5 rgb Tint] } } })
            }
        #end
    }
#end

// One bay of one storey: a panel with a window, or a balcony with a window and a door behind it.
#macro BayFront(Index, Floor)
    #local Tint = Panel * Any(0.85, 1.08);
    #local Open = (mod(Index + int(Floor / 3) + Seed, 3) = 1);
    #local Wide = 1.7 + 0.7 * Open;
    #local Sill = 0.95 - 0.9 * Open;
    #local Left = (Bay - Wide) / 2;
    #local High = 2.35 - Sill;
    union {
        union {
            box { <0.012, 0.012, 0>, <Left, Storey - 0.012, 0.4> }
            box { <Left + Wide, 0.012, 0>, <Bay - 0.012, Storey - 0.012, 0.4> }
            box { <Left, 0.012, 0>, <Left + Wide, Sill, 0.4> }
            box { <Left, Sill + High, 0>, <Left + Wide, Storey - 0.012, 0.4> }
            Surface(WALL, StoneTexture(Tint, Any(0, 50)))
        }
        object { Window(Wide, High, White, int(rand(BuildingSeed) + 0.5)) translate <Left, Sill, 0> }
        #if (Open)
            object { Balcony(Bay - 0.5, <Any(0.1, 0.5), Any(0.15, 0.4), Any(0.15, 0.45)>) translate <0.25, 0.1, 0> }
        #else
            box { <Left - 0.08, Sill - 0.06, -0.12>, <Left + Wide + 0.08, Sill, 0.2> Surface(WALL, MetalTexture(0.5)) }
            #if (rand(BuildingSeed) < 0.2) object { Flowers(Wide) translate <Left, Sill, 0> } #end
            #if (rand(BuildingSeed) < 0.2)
                box { <Left + 0.1, Sill - 0.75, -0.32>, <Left + 0.85, Sill - 0.2, 0> Surface(OBJECT, MetalTexture(0.7)) }
            #end
        #end
        translate <Bay * Index, Storey * Floor, 0>
    }
#end

#macro Entrance(X, Number)
    union {
        box { <-1.2, 0, -0.05>, <1.2, 2.5, 0.3> Surface(WALL, AshlarTexture(<0.4, 0.25, 0.18>, X)) }
        box { <-0.85, 0, -0.07>, <0.85, 2.2, -0.02> Surface(DOOR, WoodTexture(<0.35, 0.16, 0.08>, X)) }
        box { <-0.03, 0, -0.09>, <0.03, 2.2, -0.06> Surface(DOOR, MetalTexture(0.6)) }
        #for (I, 0, 1) box { <-0.65 + 0.8 * I, 0.9, -0.09>, <-0.15 + 0.8 * I, 2.0, -0.06>
            Surface(WINDOW, GlowTexture(<0.2, 0.2, 0.18>, <1.6, 1.2, 0.7> * LampsOn)) } #end
        box { <-1.5, 2.5, -1.4>, <1.5, 2.65, 0.1> Surface(ROOF, StoneTexture(<0.4, 0.4, 0.38>, X)) }
        text { internal 2 Number 0.05, 0 scale 0.6 translate <1.3, 2.0, -0.06> Surface(SIGN, PaintTexture(<0.1, 0.2, 0.5>, X)) }
        sphere { <0, 2.42, -0.8>, 0.1 no_shadow Surface(LAMP, GlowTexture(0.8, <5, 4, 2.4> * LampsOn)) }
        LampLight(<0, 2.3, -0.8>, <3, 2.3, 1.3>, 2.2)
        translate <X, 0.3, FrontAt>
    }
#end

#macro Mast(X, Z)
    union {
        cylinder { 0, 5.2 * y, 0.06 }
        cylinder { 5.2 * y, <0, 5.4, -0.7>, 0.04 }
        box { <-0.12, 5.3, -1.0>, <0.12, 5.42, -0.5> }
        box { <-0.1, 5.27, -0.97>, <0.1, 5.31, -0.53> no_shadow Surface(LAMP, GlowTexture(0.8, <5, 4.4, 3> * LampsOn)) }
        LampLight(<0, 5.1, -0.8>, <5, 4.1, 2.6>, 3.4)
        Surface(LAMP, MetalTexture(<0.25, 0.3, 0.28>))
        translate <X, 0, Z>
    }
#end

#declare Scene = union {
    plane { y, 0 Surface(GROUND, PuddledTexture(AshlarTexture(<0.45, 0.44, 0.42>, 2.4))) }
    box { <-40, -0.2, 12.6>, <40, 0.12, 15.5> Surface(PLANT, texture {
        pigment { granite scale 0.3 color_map { [0 rgb <0.03, 0.06, 0.02>] [0.5 rgb <0.10, 0.20, 0.05>] [1 rgb <0.3, 0.3, 0.12>] } }
        normal { granite 1.2 scale 0.08 }
    }) }
    union {
        #for (F, 0, Storeys - 1) #for (I, 0, Bays - 1) BayFront(I, F) #end #end
        box { <0, 0, 0.2>, <Bays * Bay, Storeys * Storey, 8> Surface(WALL, StoneTexture(<0.3, 0.3, 0.3>, 1)) }
        box { <-0.3, Storeys * Storey, -0.3>, <Bays * Bay + 0.3, Storeys * Storey + 0.5, 8>
            Surface(ROOF, StoneTexture(<0.4, 0.4, 0.42>, 3)) }
        translate <-18, 1.2, FrontAt>
    }
    box { <-18, 0, FrontAt - 0.06>, <-18 + Bays * Bay, 1.2, FrontAt + 2> Surface(WALL, AshlarTexture(<0.38, 0.35, 0.33>, 7)) }
    Entrance(-8.5, "14") Entrance(1.7, "16") Entrance(11.9, "18")
    Mast(Varied(-5.2, 0.4), 11.5) Mast(Varied(4.6, 0.4), 11.5) Mast(Varied(12.5, 0.2), 11.5)
    object { Tree(2.6, 1.7, <0.14, 0.27, 0.07>) translate <Varied(-11, 0.3), 0, 13.6> }
    object { Tree(1.8, 1.0, <0.25, 0.22, 0.05>) translate <Varied(6.6, 0.5), 0, 13.8> }
    object { Tree(2.2, 1.4, <0.12, 0.24, 0.09>) translate <Varied(14.5, 0.2), 0, 14> }
    #for (I, 0, 13) object { Bush(Grown(0.35, 0.6), <Grown(0.1, 0.25), 0.26, 0.06>)
        translate <-14 + 2.1 * I + Grown(-0.6, 0.6), 0.1, 14.6> } #end
    #for (I, 0, 3)
        box { <0, 0, 0>, <0.62, 1.1, 0.7>
            Surface(OBJECT, PaintTexture(<0.08 + 0.1 * mod(I, 3), 0.18, 0.12 + 0.08 * I>, I))
            translate <-2.6 + 0.75 * I, 0, 11.9> }
    #end
}
FinishOutdoors(Scene)
