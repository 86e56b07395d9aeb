# The cases of the golden test, for check and accept-golden: sourced, not run. A case is a clip of which a few frames are kept,
# or a plot. golden_draw fills a folder with its frames.
golden_here=$(dirname "${BASH_SOURCE[0]}")
golden_scenes=(falling_boxes bouncing_balls dominoes tower_hit tennis_racket mixed_heap newtons_cradle paddle furniture turntable)
golden_overlays=(contacts normals impulses forces loads velocity omega momentum angular-momentum trails ghosts aabb axes com islands
    sleep names damage title,clock,mode)
golden_cases=("${golden_scenes[@]}" furniture_transparent "${golden_overlays[@]/#/overlay_}"
    plot_inset plot_beside plot_below plot_file layout_row layout_grid layout_plot)

golden_frames() {   # golden_frames CASE: the numbers of its frames, at 60 frames per second
    case $1 in
        overlay_sleep | overlay_islands) echo 75 ;;
        plot_file) echo 0 ;;
        overlay_* | plot_* | layout_*) echo 40 ;;
        *) echo 0 45 90 ;;
    esac
}
golden_draw() {   # golden_draw TUMBLE CASE FOLDER
    local small=(--size 160x90 --fps 60 --duration 1.5 --quiet) large=(--size 640x360 --duration 1.3 --quiet)
    local demos=$golden_here/../../assets/scenes overlays=$golden_here/scenes/overlays.toml
    case $2 in
        *_transparent) "$1" render "$demos/${2%_transparent}.toml" --transparent --frames "$3" "${small[@]}" ;;
        overlay_*) "$1" render "$overlays" --overlay "${2#overlay_}" --frames "$3" "${large[@]}" ;;
        plot_file) mkdir -p "$3" && "$1" plot "$overlays" --of energy,body.crate.y,body.ball.y,contacts --size 640x480 --quiet \
            -o "$3/frame_000000.png" ;;
        plot_*) "$1" render "$overlays" --plot energy,body.crate.y,body.ball.y --plot-place "${2#plot_}" --overlay clock \
            --frames "$3" "${large[@]}" ;;
        layout_row) "$1" render "$overlays" --vary body.crate.restitution=0,0.8 --overlay velocity,clock --frames "$3" "${large[@]}" ;;
        layout_grid) "$1" render "$overlays" --vary body.crate.restitution=0,0.3,0.6,0.9 --layout grid --overlay trails \
            --frames "$3" "${large[@]}" ;;
        layout_plot) "$1" render "$overlays" --vary simulation.impacts=stepped,exact --plot body.ball.y --overlay title,clock \
            --frames "$3" "${large[@]}" ;;
        *) "$1" render "$demos/$2.toml" --frames "$3" "${small[@]}" ;;
    esac
}
golden_name() { printf '%s_%06d.png' "$1" "$2"; }
