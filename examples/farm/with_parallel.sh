#!/bin/sh
# with_parallel.sh JOB [HOST,HOST,...]: does the missing tasks with GNU parallel, one at a time on each host (":" is this one).
#
# Each task is tried four times at most. GNU parallel does not look at why one failed: a task that ends with 65 fails four times, quickly.
# What each try came to stands in parallel.log.
set -eu
here=$(dirname "$0")
"$here/missing.sh" "$1" | parallel --jobs 1 -S "${2:-:}" --retries 4 --joblog parallel.log enfilade --quiet farm work "$1" --task {}
