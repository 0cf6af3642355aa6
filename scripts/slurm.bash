# Functions for a Slurm cluster on this host; scripts source this file. Controller and nodes are in network namespaces
# joined by a bridge, so they reach nothing outside, and a node's link can be cut.
#   in_own_network "$@"     call this first, in the root of the tree; runs the script again in a network namespace, or
#                           ends it with status 77 if that is not allowed
#   start_slurm NODE ...    starts nodes of one processor each, in the partitions batch and urgent
#   end_slurm               ends the cluster; for a trap
#   cut_link NODE, mend_link NODE
#   wait_until WHAT CONDITION   waits at most 100 s, then ends the script
# $home must be a directory of the script's own. Packages: the group cluster of scripts/packages.
host=$(hostname -s)

in_own_network() {
    [ -z "${STORMCELLAR_OWN_NETWORK:-}" ] || return 0
    unshare --net true 2>/dev/null || { echo "${0##*/}: may not make a network of its own"; exit 77; }
    export STORMCELLAR_OWN_NETWORK=1
    exec unshare --net "scripts/${0##*/}" "$@"
}

wait_until() {
    local until=$((SECONDS + 100))
    until eval "$2" 2>/dev/null; do
        [ $SECONDS -lt $until ] || { echo "${0##*/}: waited in vain for $1" >&2; exit 1; }
        sleep 0.2
    done
}

# make_network NODE ...: the controller is 10.88.0.1, the first node 10.88.0.2.
make_network() {
    local node number=1 holder
    ip link set lo up
    ip link add sc0 type bridge
    ip addr add 10.88.0.1/24 dev sc0
    ip link set sc0 up
    for node in "$@"; do
        number=$((number + 1))
        # The namespace exists as long as this process.
        unshare --net sleep infinity &
        holder=$!
        echo $holder >"$home/network.$node.pid"
        wait_until "the network of $node" '[ "$(readlink /proc/'$holder'/ns/net)" != "$(readlink /proc/self/ns/net)" ]'
        ip link add "to-$node" type veth peer name eth0 netns $holder
        ip link set "to-$node" master sc0 up
        nsenter --target $holder --net bash -c \
            "ip addr add 10.88.0.$number/24 dev eth0; ip link set eth0 up; ip link set lo up"
    done
}

cut_link() { ip link set "to-$1" down; }
mend_link() { ip link set "to-$1" up; }

start_node() { nsenter --target "$(cat "$home/network.$1.pid")" --net slurmd -N "$1"; }

write_slurm_conf() {
    local node number=1
    cat >"$SLURM_CONF" <<CONF
ClusterName=stormcellar
SlurmctldHost=$host(10.88.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$home/munge.sock,cred_expire=6
SlurmctldPort=16817
SlurmdPort=17001
StateSaveLocation=$home/ctld
SlurmdSpoolDir=$home/%n
SlurmctldPidFile=$home/slurmctld.pid
SlurmdPidFile=$home/slurmd.%n.pid
SlurmctldLogFile=$home/slurmctld.log
SlurmdLogFile=$home/slurmd.%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
SlurmdTimeout=10
KillWait=2
JobRequeue=1
RequeueExit=75
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SchedulerParameters=sched_interval=2,sched_min_interval=0,batch_sched_delay=0
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
CONF
    for node in "$@"; do
        number=$((number + 1))
        echo "NodeName=$node NodeHostname=$host NodeAddr=10.88.0.$number CPUs=1 RealMemory=4000"
    done >>"$SLURM_CONF"
    cat >>"$SLURM_CONF" <<CONF
PartitionName=batch Nodes=ALL Default=YES PriorityTier=1 PreemptMode=REQUEUE
PartitionName=urgent Nodes=ALL PriorityTier=10 PreemptMode=OFF
CONF
}

start_slurm() {
    export SLURM_CONF=$home/slurm.conf
    mkdir -p "$home/ctld"
    dd if=/dev/urandom of="$home/munge.key" bs=128 count=1 status=none
    chmod 400 "$home/munge.key"
    make_network "$@"
    write_slurm_conf "$@"
    munged --key-file="$home/munge.key" --socket="$home/munge.sock" --pid-file="$home/munged.pid" \
        --seed-file="$home/munge.seed" --log-file="$home/munge.log" --force 2>/dev/null
    slurmctld
    local node
    for node in "$@"; do
        mkdir -p "$home/$node"
        start_node "$node"
    done
    wait_until "$# idle nodes" '[ "$(sinfo -h -o %D -t idle -p batch)" = '$#' ]'
}

# Stops the daemons by their pid files, and waits until they have ended.
end_slurm() {
    local file process
    [ ! -s "$home/slurmctld.pid" ] || timeout 10 scancel -u root 2>/dev/null || true
    for file in "$home"/slurmd.*.pid "$home"/slurmctld.pid "$home"/munged.pid "$home"/network.*.pid; do
        [ -s "$file" ] || continue
        process=$(cat "$file")
        kill "$process" 2>/dev/null || continue
        timeout 10 tail --pid="$process" -f /dev/null || kill -9 "$process" 2>/dev/null || true
    done
}
