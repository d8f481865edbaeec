"""Safe storage of files and results: atomic files, named arrays, fingerprints, and the pieces of a resumable run."""
