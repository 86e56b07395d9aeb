#!/bin/bash
# The last job, after the end of all tasks of the array, failed ones too: checks that all frames are there, and makes the
# clip. If frames are missing, it submits their parts and itself again, at most "retries" times.
#   bash stitch.sh                    by hand
@SBATCH@
set -u
source @SETTINGS@ || exit
round=${1:-0}
missing=$("$program" farm status "$folder" --missing)
code=$?
if ((code == 3)); then
    "$program" farm status "$folder" >&2
    if [[ ! -e $folder/checkpoints/clip.tumble ]]; then
        echo "the simulation has not finished (log/simulate.log); submit everything again: bash $(printf %q "$folder/submit.sh")" >&2
    elif [[ -n ${SLURM_JOB_ID-} ]] && ((round < retries)) && command -v sbatch >/dev/null; then
        echo "submitting the missing parts again ($((round + 1)) of $retries)" >&2
        bash "$folder/submit.sh" "$missing" "$((round + 1))"
    fi
    exit 1
fi
((code == 0)) || exit "$code"
exec "$program" encode "$folder/frames" -o "$clip" "${encode_options[@]}" --quiet
