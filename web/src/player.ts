// The entry of the player: finds the clips of the page and mounts a player on each.
