# The scenes and frames of the golden test, for check and accept-golden: sourced, not run.
golden_scenes=(falling_boxes bouncing_balls dominoes tower_hit tennis_racket mixed_heap newtons_cradle paddle furniture turntable)
golden_frames=(0 45 90)          # at 60 frames per second
golden_options=(--size 160x90 --fps 60 --duration 1.5 --quiet)
golden_name() { printf '%s_%06d.png' "$1" "$2"; }
