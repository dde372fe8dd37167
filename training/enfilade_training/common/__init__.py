"""What the experiments share: settings, learning rates, processes, checkpoints and logs."""
