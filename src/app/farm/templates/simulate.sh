#!/bin/bash
# The first job: simulates the scene, and writes a checkpoint where each part of the frames begins.
#   bash simulate.sh                  by hand
@SBATCH@
set -u
source @SETTINGS@ || exit
try "the simulation" "$program" simulate "${scenes[@]}" "${simulate_options[@]}" --quiet \
    --checkpoints "$folder/checkpoints" --every "$every"
