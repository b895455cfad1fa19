# SPDX-License-Identifier: GPL-3.0-or-later
# ctest: LABELS ci
# vam-batch --slurm on a real Slurm of one node: a piece is killed in the middle, another one's job is put back into the
# queue; the projections are complete and the same bytes.
. "$VAM_SOURCE/tests/tools/testlib.sh"
PATH=$VAM_SOURCE/scripts:/usr/sbin:$PATH
for program in sbatch slurmctld slurmd munged; do
  command -v $program >/dev/null || { echo "1..0 # SKIP no $program; apt-get install slurm-wlm munge"; exit 77; }
done

# ---- one node ----------------------------------------------------------------------------------------------------------
host=$(hostname -s) user=$(id -un)
mkdir -m 711 slurm slurm/state slurm/spool
head -c 64 /dev/urandom >slurm/key && chmod 600 slurm/key
cat >slurm/slurm.conf <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$scratch/slurm/socket,cred_expire=5
SlurmUser=$user
SlurmdUser=$user
SlurmctldPort=$((20000 + $$ % 20000))
SlurmdPort=$((40000 + $$ % 20000))
StateSaveLocation=$scratch/slurm/state
SlurmdSpoolDir=$scratch/slurm/spool
SlurmctldPidFile=$scratch/slurm/slurmctld.pid
SlurmdPidFile=$scratch/slurm/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=bf_interval=1,sched_interval=1
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES State=UP
CONF
SLURM_CONF=$scratch/slurm/slurm.conf; export SLURM_CONF
munged --foreground --force --key-file="$scratch/slurm/key" --socket="$scratch/slurm/socket" \
  --pid-file="$scratch/slurm/munged.pid" --log-file="$scratch/slurm/munged.log" \
  --seed-file="$scratch/slurm/seed" 2>slurm/munged.err & daemons=$!
await test -S slurm/socket
slurmctld -D >slurm/slurmctld.log 2>&1 & daemons="$daemons $!"
slurmd -D >slurm/slurmd.log 2>&1 & daemons="$daemons $!"
trap "scancel --user=$user; sleep 1; kill $daemons; wait; rm -rf '$scratch'" EXIT
node_is_idle() { [ "$(sinfo -h -o %t 2>/dev/null)" = idle ]; }
await node_is_idle || { echo '1..0 # SKIP slurmd does not start here'; tail -n 3 slurm/*.log | sed 's/^/# /'; exit 77; }

# ---- a queue of one part in two pieces ---------------------------------------------------------------------------------
cat >mortal <<'SH'
#!/bin/sh
# Runs a tool; the first time, the first piece is killed while it runs, and the job of the second one is requeued.
case "$*" in
  *--slices\ 1/2*) mkdir killed 2>/dev/null && { "$@" & tool=$!; sleep 0.4; kill -KILL $tool && : >killed/really; wait $tool; exit; } ;;
  *--slices\ 2/2*) mkdir requeued 2>/dev/null && { (sleep 0.4; scontrol requeue "$SLURM_JOB_ID" && : >requeued/really) & } ;;
esac
exec "$@"
SH
chmod +x mortal
vam-slice --print-printer --set projector.telecentric=true -o level.toml
optimize='--method apg --angles 60 --iterations 60 --patience 0'
printf 'OFF\n4 4 0\n-3 -2 0\n3 -2 0\n0 3 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >pyramid.off
printf 'part\tname\tprinter\tslice\toptimize\tpieces\npyramid.off\tpart\tlevel.toml\t--voxel 0.1\t%s\t2\n' "$optimize" >parts.tsv
quiet 'a queue is made by Slurm' vam-batch --slurm --prefix ./mortal parts.tsv
[ -e killed/really ]; report $? 'a piece was killed while it ran'
[ -e requeued/really ]; report $? 'the job of the other one was put back into the queue'
is 'no state is left of either' "$(ls batch/*.state 2>/dev/null | wc -l)" 0
is 'each job has its log' "$(cd batch/log && ls | sed 's/[0-9][0-9]*/N/g' | tr '\n' ' ')" 'end-N.log part.gather-N.log part.piece-N_N.log part.piece-N_N.log part.slice-N.log '
is 'no job is left' "$(squeue -h | wc -l)" 0
vam-optimize batch/part.vdb $optimize --printer level.toml | vam-convert join -o whole.exr
same 'the projections are those of one undivided run' batch/part.exr whole.exr
is 'the part has its figures' "$(cut -f 1 batch/summary.tsv | tr '\n' ' ')" 'name part '
is 'all is made' "$(vam-batch --plan parts.tsv | grep -c vam-)" 0
done_testing
