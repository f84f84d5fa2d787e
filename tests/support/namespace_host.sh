#!/bin/sh
# namespace_host.sh NAME FOLDER: a host for tests, in namespaces of its own for network, mounts, processes and name.
#
# Start it as `unshare --net --mount --pid --uts --fork --mount-proc --kill-child namespace_host.sh NAME FOLDER`. FOLDER
# contains `prefix` (the installation, which becomes /opt/constrictor), `ssh` (host key, authorized_keys, sshd_config,
# which become /etc/ssh), and empty folders `tmp` and `run`. The host runs sshd until it is killed.
set -eu
hostname "$1"
ip link set lo up
mount -t tmpfs none /opt
mkdir /opt/constrictor
mount --bind "$2/prefix" /opt/constrictor
mount --bind "$2/ssh" /etc/ssh
mount --bind "$2/run" /run
mkdir -p /run/sshd
mount --bind "$2/tmp" /tmp
unset XDG_RUNTIME_DIR
exec /usr/sbin/sshd -D -e -f /etc/ssh/sshd_config
