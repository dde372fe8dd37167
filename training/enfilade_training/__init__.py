"""The training experiments of the Hypersim paper (Roberts et al., ICCV 2021): `segmentation` and `shapes`.

Here are recipes only. Files are decoded, tone-mapped and scored by the module `enfilade`, which is Rust; PyTorch trains.
"""
