# Settings of the scripts in this folder. Written by tumble farm slurm.
@VALUES@

# try NAME COMMAND...: runs the command, and again while it fails, at most "retries" times. Wrong input (exit code 2) stays
# wrong, and is not tried again.
try() {
    local name=$1 again code
    shift
    for ((again = 0; ; again++)); do
        "$@" && return 0
        code=$?
        echo "$name failed on $(hostname) with exit code $code" >&2
        ((code == 2 || again >= retries)) && return "$code"
        echo "$name: trying again ($((again + 1)) of $retries)" >&2
    done
}
