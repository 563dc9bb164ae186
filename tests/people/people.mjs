// Who person.mjs can make. A shape target moves the body's vertices; its weight is 0 to 1.
const Skin = (age, race, gender, picture) =>
  `${age}_${race}_${gender}/textures/${age}_${picture}_diffuse`;

export const PEOPLE = {
  anna: {
    gender: 'female', age: 'young', race: {caucasian: 1},
    shape: {'head/head-oval': 0.5, 'nose/nose-scale-vert-decr': 0.4, 'chin/chin-width-min': 0.4,
            'asym/asym-cheek-1-l': 0.5},
    skin: Skin('young', 'caucasian', 'female', 'lightskinned_female') + '.png',
    hair: 'long01', brows: 'eyebrow002', lashes: 'eyelashes02', eyes: 'blue', clothes: 'VNeckTop',
  },
  bayo: {
    gender: 'male', age: 'young', race: {african: 1},
    shape: {'head/head-square': 0.4, 'chin/chin-width-max': 0.4, 'nose/nose-width1-max': 0.3},
    skin: Skin('young', 'african', 'male', 'darkskinned_male') + '.png',
    hair: 'short01', brows: 'eyebrow003', lashes: 'eyelashes02', eyes: 'brown',
    clothes: 'male_casualsuit02',
  },
  chen: {
    gender: 'female', age: 'young', race: {asian: 1},
    shape: {'head/head-round': 0.5, 'mouth/mouth-scale-horiz-decr': 0.4},
    skin: Skin('young', 'asian', 'female', 'lightskinned_female') + '3.png',
    hair: 'bob01', brows: 'eyebrow006', lashes: 'eyelashes03', eyes: 'brown',
    clothes: 'female_casualsuit01',
  },
  dieter: {
    gender: 'male', age: 'old', race: {caucasian: 1},
    shape: {'nose/nose-hump-morehump': 0.6, 'nose/nose-scale-depth-incr': 0.4,
            'head/head-rectangular': 0.5},
    skin: Skin('old', 'caucasian', 'male', 'lightskinned_male') + '.png',
    hair: null, brows: 'eyebrow009', lashes: 'eyelashes03', eyes: 'grey',
    clothes: 'male_elegantsuit01',
  },
  emeka: {
    gender: 'male', age: 'young', race: {african: 0.7, caucasian: 0.3},
    shape: {'head/head-triangular': 0.4, 'forehead/forehead-scale-vert-more': 0.4},
    skin: 'middleage_african_male/textures/middleage_darkskinned_male_diffuse.png',
    hair: 'afro01', brows: 'eyebrow001', lashes: 'eyelashes02', eyes: 'brown',
    clothes: 'male_casualsuit04',
  },
  fatou: {
    gender: 'female', age: 'young', race: {african: 1},
    shape: {'head/head-diamond': 0.5, 'mouth/mouth-scale-vert-incr': 0.4},
    skin: Skin('young', 'african', 'female', 'darkskinned_female') + '.png',
    hair: 'Braid01', brows: 'eyebrow007', lashes: 'eyelashes04', eyes: 'brown',
    clothes: 'female_casualsuit02',
  },
  georg: {
    gender: 'male', age: 'young', race: {caucasian: 1},
    shape: {'head/head-scale-depth-more': 0.5, 'chin/chin-prominent-more': 0.5,
            'nose/nose-scale-vert-incr': 0.4, 'asym/asym-cheek-2-r': 0.5},
    skin: 'middleage_caucasian_male/textures/middleage_lightskinned_male_diffuse.png',
    hair: 'short02', beard: 'Full_beard', brows: 'eyebrow010', lashes: 'eyelashes03',
    eyes: 'green', clothes: 'male_casualsuit06',
  },
  hana: {
    gender: 'female', age: 'old', race: {asian: 1},
    shape: {'head/head-scale-vert-less': 0.4, 'cheek/l-cheek-volume-deflate': 0.4,
            'cheek/r-cheek-volume-deflate': 0.4},
    skin: Skin('old', 'asian', 'female', 'lightskinned_female') + '2.png',
    hair: 'ponytail01', brows: 'eyebrow011', lashes: 'eyelashes02', eyes: 'brown',
    clothes: 'female_sportsuit01',
  },
  ivan: {
    gender: 'male', age: 'young', race: {caucasian: 0.6, asian: 0.4},
    shape: {'head/head-fat': 0.4, 'nose/nose-volume-potato': 0.4},
    skin: Skin('young', 'caucasian', 'male', 'lightskinned_male') + '2.png',
    hair: 'short03', brows: 'eyebrow005', lashes: 'eyelashes02', eyes: 'brownlight',
    clothes: 'male_worksuit01', glasses: 'glasses',
  },
  julia: {
    gender: 'female', age: 'young', race: {caucasian: 1},
    shape: {'head/head-invertedtriangular': 0.5, 'nose/nose-curve-concave': 0.5,
            'forehead/forehead-scale-vert-less': 0.4},
    skin: 'middleage_caucasian_female/textures/middleage_lightskinned_female_diffuse.png',
    hair: 'bob02', brows: 'eyebrow008', lashes: 'eyelashes03', eyes: 'lightblue',
    clothes: 'female_elegantsuit01', cap: 'fedora',
  },
};

/// What others are made of. The skins of anna, bayo, dieter, georg and hana are left to them: what
/// is learned from others is tried on them.
const OTHERS = {
  skins: {
    male: [['young', 'young_asian_male/textures/young_lightskinned_male_diffuse3.png'],
           ['young', 'middleage_asian_male/textures/middleage_lightskinned_male_diffuse2.png'],
           ['young', 'middleage_african_male/textures/middleage_darkskinned_male_diffuse.png'],
           ['young', 'young_caucasian_male/textures/young_lightskinned_male_diffuse2.png'],
           ['old', 'old_african_male/textures/old_darkskinned_male_diffuse.png'],
           ['old', 'old_asian_male/textures/old_lightskinned_male_diffuse2.png']],
    female: [['young', 'middleage_african_female/textures/middleage_darkskinned_female_diffuse.png'],
             ['young', 'middleage_asian_female/textures/middleage_lightskinned_female_diffuse2.png'],
             ['young', 'middleage_caucasian_female/textures/middleage_lightskinned_female_diffuse.png'],
             ['young', 'young_caucasian_female/textures/young_lightskinned_female_diffuse2.png'],
             ['young', 'young_african_female/textures/young_darkskinned_female_diffuse.png'],
             ['young', 'young_asian_female/textures/young_lightskinned_female_diffuse3.png'],
             ['old', 'old_african_female/textures/old_darkskinned_female_diffuse.png'],
             ['old', 'old_caucasian_female/textures/old_lightskinned_female_diffuse.png']],
  },
  hair: {
    male: [null, 'short04', 'short02', 'Harvey_Hawk1', 'minoan', 'short01', 'ponytail01'],
    female: ['long_alpha7', 'ponytail01', 'minoan', 'southernbelleringlets', 'long01', 'short02'],
  },
  beard: [null, null, null, 'Moustache', 'Full_beard'],
  brows: ['eyebrow001', 'eyebrow002', 'eyebrow003', 'eyebrow004', 'eyebrow006', 'eyebrow008',
          'eyebrow010', 'eyebrow011', 'eyebrow012', 'Eyebrows_01'],
  lashes: ['eyelashes02', 'eyelashes03', 'eyelashes04'],
  eyes: ['blue', 'bluegreen', 'brown', 'brown', 'brownlight', 'green', 'grey'],
  clothes: {
    male: ['male_casualsuit01', 'male_casualsuit03', 'male_casualsuit05', 'male_elegantsuit01'],
    female: ['female_casualsuit01', 'female_elegantsuit01', 'female_top_01', 'VNeckTop'],
  },
};

/// Pairs of shape targets: a person has one of the two, by up to the weight.
const SHAPES = [
  [0.5, 'head/head-oval', 'head/head-square'], [0.5, 'head/head-round', 'head/head-rectangular'],
  [0.4, 'head/head-triangular', 'head/head-invertedtriangular'],
  [0.4, 'head/head-scale-depth-less', 'head/head-scale-depth-more'],
  [0.4, 'head/head-scale-horiz-less', 'head/head-scale-horiz-more'],
  [0.4, 'head/head-scale-vert-less', 'head/head-scale-vert-more'],
  [0.5, 'head/head-fat', 'head/head-skinny'],
  [0.5, 'nose/nose-scale-vert-decr', 'nose/nose-scale-vert-incr'],
  [0.5, 'nose/nose-scale-depth-decr', 'nose/nose-scale-depth-incr'],
  [0.5, 'nose/nose-scale-horiz-decr', 'nose/nose-scale-horiz-incr'],
  [0.5, 'nose/nose-hump-lesshump', 'nose/nose-hump-morehump'],
  [0.5, 'nose/nose-point-down', 'nose/nose-point-up'],
  [0.4, 'nose/nose-trans-vert-down', 'nose/nose-trans-vert-up'],
  [0.5, 'mouth/mouth-scale-horiz-decr', 'mouth/mouth-scale-horiz-incr'],
  [0.5, 'mouth/mouth-scale-vert-decr', 'mouth/mouth-scale-vert-incr'],
  [0.4, 'mouth/mouth-trans-down', 'mouth/mouth-trans-up'],
  [0.5, 'chin/chin-width-max', 'chin/chin-width-min'],
  [0.5, 'chin/chin-height-max', 'chin/chin-height-min'],
  [0.5, 'chin/chin-prominent-less', 'chin/chin-prominent-more'],
  [0.5, 'forehead/forehead-scale-vert-less', 'forehead/forehead-scale-vert-more'],
  [0.5, 'forehead/forehead-trans-depth-backward', 'forehead/forehead-trans-depth-forward'],
  [0.5, 'eyebrows/eyebrows-trans-vert-less', 'eyebrows/eyebrows-trans-vert-more'],
  [0.4, 'eyes/[l]-eye-move-down', 'eyes/[l]-eye-move-up'],
  [0.4, 'eyes/[l]-eye-move-in', 'eyes/[l]-eye-move-out'],
  [0.5, 'eyes/[l]-eye-size-big', 'eyes/[l]-eye-size-small'],
  [0.5, 'cheek/[l]-cheek-bones-in', 'cheek/[l]-cheek-bones-out'],
  [0.5, 'cheek/[l]-cheek-volume-deflate', 'cheek/[l]-cheek-volume-inflate'],
];

/// Somebody, the same for the same @p seed.
export function RandomPerson(seed) {
  let state = seed;
  const Random = () => {  // mulberry32
    state = (state + 0x6D2B79F5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
  for (let i = 0; i < 8; ++i) Random();
  const One = (list) => list[Math.floor(Random() * list.length)];
  const gender = One(['male', 'female']);
  const [age, skin] = One(OTHERS.skins[gender]);
  const weights = [Random(), Random(), Random()].map((x) => x * x);
  const sum = weights[0] + weights[1] + weights[2];
  const race = {};
  ['african', 'asian', 'caucasian'].forEach((r, i) => { race[r] = weights[i] / sum; });
  const shape = {};
  for (const [most, less, more] of SHAPES) {
    const w = most * (2 * Random() - 1), target = w < 0 ? less : more;
    for (const side of target.includes('[l]') ? ['l', 'r'] : [''])
      shape[target.replace('[l]', side)] = Math.abs(w);
  }
  return {
    gender, age, race, shape, skin, hair: One(OTHERS.hair[gender]),
    beard: gender === 'male' ? One(OTHERS.beard) : null, brows: One(OTHERS.brows),
    lashes: One(OTHERS.lashes), eyes: One(OTHERS.eyes), clothes: One(OTHERS.clothes[gender]),
  };
}
