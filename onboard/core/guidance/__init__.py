"""What becomes of a decided velocity on its way to an autopilot. Kernel style."""
