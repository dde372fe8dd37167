#!/bin/sh
# missing.sh JOB: the tasks that are still to be done, one number per line.
enfilade farm status "$1" --missing | tr ',' '\n' | awk -F- 'NF { for (i = $1; i <= $NF; i++) print i }'
