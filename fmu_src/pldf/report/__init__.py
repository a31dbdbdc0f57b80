"""What people look at: figures for papers, and the interactive report."""
