"""3D shape prediction, the task of Mesh R-CNN on Pix3D: from one image to the mesh of every object.

    enfilade export out --format pix3d -o rooms
    python -m enfilade_training.shapes train training/configs/shapes-pretrain-enfilade.toml

Camera space is x left, y up, z forward, in any unit of length. The network works in the frustum of a region of the image, which
`frustum` brings to the box from -1 to 1: x right, y down, z away.
"""
