# shellcheck shell=bash
# The scenarios of scripts/figures.

# Name and simulator's flags of the scenarios of a table.
Scenarios() {
  [[ $1 == hard || $1 == wide ]] || cat <<'SCENARIOS'
shuttle_x_T=15_s --scenario shuttle_x --period 15
shuttle_x_T=7_s --scenario shuttle_x --period 7
shuttle_x_T=1_s --scenario shuttle_x --period 1
orbit_theta_T=20_s --scenario orbit_theta --period 20
moving_head --scenario moving_head
head_absent_4_to_6_s --scenario shuttle_x --period 15 --set scenario.absent_from_s=4 --set scenario.absent_until_s=6
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
