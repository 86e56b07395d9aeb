# The scenes and frames of the golden test, for check and accept-golden: sourced, not run. The name of a scene with
# "_transparent" after it: the same with --transparent.
golden_scenes=(falling_boxes bouncing_balls dominoes tower_hit tennis_racket mixed_heap newtons_cradle paddle furniture turntable furniture_transparent)
golden_frames=(0 45 90)          # at 60 frames per second
golden_options=(--size 160x90 --fps 60 --duration 1.5 --quiet)
golden_scene_folder=$(dirname "${BASH_SOURCE[0]}")/../../assets/scenes
golden_draw() {   # golden_draw TUMBLE SCENE FOLDER
    local more=()
    [[ $2 != *_transparent ]] || more=(--transparent)
    "$1" render "$golden_scene_folder/${2%_transparent}.toml" --frames "$3" "${golden_options[@]}" "${more[@]}"
}
golden_name() { printf '%s_%06d.png' "$1" "$2"; }
