"""Building the archives; nothing in here is packed into one."""
