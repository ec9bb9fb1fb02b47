// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Generated, do not edit: scripts/train.sh --presets --seed=1 WALKS/path
// Seed 1, trained on:
//   amos_daynight/cam00
//   amos_daynight/cam01
//   amos_daynight/cam02
//   amos_daynight/cam03
//   amos_daynight/cam04
//   amos_daynight/cam05
//   amos_daynight/cam06
//   path/room_0, where points are detected
//   path/terrain_0, where points are detected
//   tilde_webcam/chamonix
//   tilde_webcam/courbevoie
//   tilde_webcam/panorama
// One base-32 digit, the bit mask, per level, row, column and channel; w, x, y, z are runs of 2, 4, 8, 16 zeros.

static const char S128_MASKS[] =
    "w055xdayw52x3c0441w0822w028xc24zx0284w0402w08x08c2zxwc8w03x0d03x38zx0314w0402w043x388y8x08zzzzyx"
    "82y0401yw01x01zzzyw41w01xw01x08x1yx1x08zzyxw1xw8yw61w0806x02yw08zzyxw05w03yx05x2xw4x23x02zzzx22y"
    "w02x22z23zzzx04x01x4x01x028yw22zzyxw4cyw01x41yw04x02x06";

static const char S256_MASKS[] =
    "w045xecyw54x7c05c1w0a22w0acxd24zx0e95w0502w088xcc2zx0ac8w038xd03w0438zx0355w0572w0c3x388848w0288"
    "w0388w04x0802x1x201w0808zzyxw8ax04w0401x2xw1x43w04xw19zzyx03c3w01xw01x68x14yw21x08zzyx0113x08w0c"
    "08w0461w0806x42w0c19w0818zzyx0215w03x0233x05x21w0205xa3w0102zzyx0848w012ayw4aw0122x28w07xw23zzyx"
    "w55w0404w0825w0148w021dx28w022x822zzyx04cew02xw09xc1x14x04w0c22w050e";

static const char S512_MASKS[] =
    "ff0d7xfcywdcxfe0dc1w0b32w0fe1w0fa4zx0ff5w07c2w09dxec3zx0bd8w0393w0f23w0f78zx0b75w0f72w0f34w0bc8e"
    "5ew0388w03c8w0ed8w0e93w0c94w0721w0aebzzyxwcaw0c0cw0cc5w0827w0f01w08c3w04a2w0539zzyx03c3w0561w0a0"
    "1w0c68w0a1cw0483w0aa5w06c8zzyx05b3w0838w0c3aw0c61w0806w05c3w0c1fw0b1czzyx0717w0364w0a33x45w05a1w"
    "0f85w05bbw0573zzyx0afew0faaw033x1daw03a3w0429w0f22w0eabzzyx0955w0c44w0a35w094ew0a1dx3aw0a28w08aa"
    "zzyx07cew0aexd0dw09c5w0735w0dccw0cbew0fbe";

static const char COMPACT_MASKS[] =
    "76315714x5757yx7612x76643376x7612x7171x3377zyx7234x7057x7654x3756zyx5247x723x07252x7212zyx7353x7"
    "317x7352x77473236x321x0133x03013x1211x113x03616x1373zzzyx325x01032x1254x162x01256x1204x1203x5332"
    "zzzyx3616x127xw017x1233x3102x3202x101x03611zzzyx0232x3211x2252x1034x0246x1211x1206x3234zzzyx3376"
    "x3222x124x03032x1251x1207x1633x1257zzzyx3226x123x03317x2212x1204xw55x1236x1213zzzyx3372x5211x323"
    "2x1353x3013x3212x1207x1052zzzyx3257x3271x3236x1272x3236x3215x3213x7277";

static const char TINY_MASKS[] =
    "75131414x1256yx3202x5w0131x01202x304x03256zyx5234x1057x1254x3257zyx1247x301x02052x1212zyx711x052"
    "07x52xw72461036x02yxw1w3x1w1yx02y12zzzyx1xw01012x021xw02xw2xw1xw01w1xw12zzzyxw12xw3y5x0212x3y202"
    "xw14xw01zzzyx0212xw1xw252xw14x0252xw11xw02x101zzzyx01212x102x0104y2x0211x1w2x021xw206zzzyx0206x1"
    "2y07xw12x12y1x01016x0212zzzyx0232xw1x01232x1013xw02x321x01202x1zzzyxw01217x0211x023xw012x023x012"
    "xw3012x1213";

static const char BALANCED_MASKS[] =
    "fffffffcfff4fff4fffcfff8fffcfff1fff1fbfcc681x2e9x07433x605zyx0ac88xfffexffffxd4a8zyx73fx0fff3xff"
    "fbx393zyxw31x06efx0ba38x321082y2xw4xw202xw01x0886xw4zzzzxw804x02841x0141x0c81x02xw106zzzzzy1xfw8"
    "xcce3xdd42x0d5x08y808zzzzxw8x0eac8xffffxffffxcfdx08xw0c04zzzzxw33x0fab2xffffxffffx7771x01xw8w1zz"
    "zyxw1yx0382x03236x3d7ax309yxw08zzzzxw05x02w1x0401x8882x041cx4181x0108zzzyx902xw098yx0208x0202xc2"
    "09x43ya0";

static const char VIEWPOINT_MASKS[] =
    "123hq3761x8037w23721y08yw0b11w13282a211g1031ax0bw4036w0113w013w8x0338w11w4x0240gx030310131w013w3"
    "3w08wo08x8xw0gyx2x13w3x9022w2yx03x9x13202a1w8111g2a3w08x0111081110637147350g130129y01xb101016402"
    "21110301w101w8x9x301w233g031w8110h811yxw22waxa020802x03zzx08zzw8zyxw01w021zzw1w222w102g02zzw9711"
    "28375ub01w02zxw031380930d0f721o1311g01zxw0802w12w9303gg022xw08zy02w0810g1w1w8zyx08y08x8y08zyx08y"
    "8yw8x01wgw2w8w02022yx101w901wa3312312h217210911hx808w103301gf77taf76peb21p08y0bxe2190f76lmf73lub"
    "12ho1x8xw01023210a23gg9308ea03ohw1w8x022w901w81w0822w802g89w1zx08x8y08x";

static const char UNIVERSAL_MASKS[] =
    "f7382776g28w0873053773kx0gw0gxg8w08g930g09130i31wma71108w0g32448140k83211g534g08w80973w355w704w3"
    "51148w8022102f122042110a1xwox8xg88y08w0g921089011023040e73cnb42g82w108xaw30f109gf721gf5010e27101"
    "34018x1101a7701073732774g235440b7102x0b74a0d15907304b7541id6090520d4x0a308032w031312236wb130idx8"
    "x9x823wb2w8b2w21164w3104w0g08y08yg8x8w088xw3801x822w114w812wa018w1yx083x2122a4w0923843217x01041w"
    "42w08xw0108010a02510e35wf325a232108yxw144w10714b61wd205ff75l693716803042w208xw2888110272380935li"
    "b30lk213a2145841w02w08g8w088x9112ge3302f118of219iw520620818w802y08x23210a230g0110201wca02xw08wkw"
    "01w8210h9310801301awgw05w022w8x8yg8x8w0g8w808w808x8wgxw8021011010b370if3283031gw3w08x820h0f0512f"
    "371ua775ma65d0801108x9311gb375bf7776f77nub77feb06028x92012777t2f77duf77tve31tq925b88x911w933wf32"
    "m7b33tub35dsd22188wogxw044gb7342837gw20h0804g08y08wg08wg08w0g8ygx0";

static const char SMALL_MASKS[] =
    "303123x8wg061x121zxw3w0910g0bw0a02yw1x4w135w351y1w01y02y0801w023w1x31yx08y08w0oz02w02zxw012w0212"
    "w020gz1x161w853w24402w2yxw1w3x5201073410111w901yx020gw12w21102022x01z202w021w812w02y8zzzzzyw02zz"
    "z23x1zz2111022w211010922x1zxw2x021121wgg81018zyxw213w1201zzxw2zzzzzzzyx3wax022zy3w131x31822yx01w"
    "1091010637l6916g41211yx01w221h0d36wf65w8131210118yw802w20202811hg8w08zx81x02xw8zy08zw0";

static const LearnedSelection PRESETS[] = {
    {1.000f, 4, 11, 0, S128_MASKS},  // S128
    {1.000f, 4, 11, 0, S256_MASKS},  // S256
    {1.000f, 4, 11, 0, S512_MASKS},  // S512
    {1.250f, 4, 51, 6, nullptr},  // ACCURATE
    {1.250f, 4, 51, 5, COMPACT_MASKS},  // COMPACT
    {1.250f, 4, 51, 5, TINY_MASKS},  // TINY
    {1.125f, 4, 43, 0, BALANCED_MASKS},  // BALANCED
    {1.250f, 5, 59, 7, VIEWPOINT_MASKS},  // VIEWPOINT
    {1.250f, 5, 59, 7, UNIVERSAL_MASKS},  // UNIVERSAL
    {1.250f, 5, 59, 7, SMALL_MASKS},  // SMALL
};
