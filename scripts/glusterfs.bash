# Functions for a shared file system, GlusterFS, on this host; a script sources this file after scripts/slurm.bash.
#   start_share       makes a volume of one brick at 10.88.0.1, which must be an address of this network
#   on_share COMMAND  runs a command as on another machine, with its own mount of the share at $home/share
#   end_share         ends the share; for a trap
# $home must be a directory of the script's own. Packages: the group cluster of scripts/packages.

share_command() { gluster --mode=script --glusterd-sock="$home/glusterd.sock" volume "$@" >>"$home/gluster.log" 2>&1; }

start_share() {
    mkdir -p "$home/brick" "$home/glusterd/run" "$home/share"
    cat >"$home/glusterd.vol" <<CONF
volume management
    type mgmt/glusterd
    option working-directory $home/glusterd
    option run-directory $home/glusterd/run
    option glusterd-sockfile $home/glusterd.sock
    option transport-type socket
    option transport.socket.listen-port 24007
end-volume
CONF
    glusterd -f "$home/glusterd.vol" -p "$home/glusterd.pid" -l "$home/glusterd.log"
    wait_until "the shared file system" 'share_command create share "10.88.0.1:$home/brick" force || share_command info share'
    share_command start share
    wait_until "a mount of it" 'on_share touch "$home/share/mounted"'
}

on_share() {
    unshare --mount bash -c 'mount -t glusterfs 10.88.0.1:/share "$0" && exec "$@"' "$home/share" "$@"
}

end_share() {
    [ -s "$home/glusterd.pid" ] || return 0
    share_command stop share force || true
    kill "$(cat "$home/glusterd.pid")" 2>/dev/null || true
}
