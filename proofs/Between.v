(** * Unstable at two steps with one label: unstable at every step in between

    A step of determinant 1 turns directions. Over a period a direction turns clockwise, and N counts its half turns:
    the label of the gap that the period lies in. Kicks and drifts that are larger turn further. So where some direction
    turns by N half turns or more at the smaller step, and some direction by N half turns or less at the larger one,
    the same holds at a step in between, of the two directions at once: its period maps an arc into itself.

    direction x       == the direction of angle x, (cos x, sin x)
    lift F            == a strictly increasing map of angles that respects half turns
    sends M F         == M sends the direction x to a positive multiple of the direction F x
    compose f n       == f (n - 1) after ... after f 0
    clockwise M       == M turns each direction clockwise, by less than a half turn
    turned M          == the map of angles of such an M
    shear b s         == the kick (b true) or the drift (b false) of strength s
    at_strength b s k == the map of angles of the k-th shear

    - [between]          the arc that the period maps into itself, after N half turns;
    - [arc_hyperbolic]   a matrix that does so is hyperbolic: Tr > 2 for even N, Tr < -2 for odd N;
    - [between_unstable] both: the step in between is unstable;
    - [turned_lift]      the map of angles exists: it is a lift, and turns by less than a half turn;
    - [further_turned]   what turns further does so at every angle;
    - [clockwise_shear], [further_shear]   kicks and drifts turn clockwise, larger ones further;
    - [between_shears]   hence the same for a period of kicks and drifts, with nothing left to suppose about lifts;
    - [between_steps]    and with nothing but one direction at either of the two steps.                              *)

From Kickdrift Require Import Vocabulary Algebra Stability Plane Cone.
From Coq Require Import Reals ZArith Lra Lia Psatz.
Open Scope R_scope.

Definition direction (x : R) := Vec (cos x) (sin x).

Definition lift (F : R -> R) := (forall x y, x < y -> F x < F y) /\ (forall x, F (x + PI) = F x + PI).

Definition sends (M : mat) (F : R -> R) :=
  forall x, exists c, 0 < c /\ M @ direction x = smul c (direction (F x)).

Fixpoint compose (f : nat -> R -> R) (n : nat) (x : R) : R :=
  match n with O => x | S n' => f n' (compose f n' x) end.

Lemma lift_le F x y : lift F -> x <= y -> F x <= F y.
Proof. intros [I _] [L | ->]; [left; now apply I | right; reflexivity]. Qed.

Lemma lift_half_turns F j x : lift F -> F (x + IZR j * PI) = F x + IZR j * PI.
Proof.
  intros [_ P]; revert j; apply Z.peano_ind.
  - now rewrite !Rmult_0_l, !Rplus_0_r.
  - intros j IH; rewrite succ_IZR.
    replace (x + (IZR j + 1) * PI) with (x + IZR j * PI + PI) by ring; rewrite P, IH; ring.
  - intros j IH; pose proof (P (x + (IZR j - 1) * PI)) as E.
    rewrite <- Z.sub_1_r, minus_IZR.
    replace (x + (IZR j - 1) * PI + PI) with (x + IZR j * PI) in E by ring; lra.
Qed.

Lemma compose_lift f n : (forall k, (k < n)%nat -> lift (f k)) -> lift (compose f n).
Proof.
  induction n as [|n IH]; intros L; simpl; [split; auto|].
  destruct IH as [I P]; [intros; apply L; lia|]; destruct (L n) as [I' P']; [lia|].
  split; intros; [now apply I', I | now rewrite P, P'].
Qed.

(** ** The arc *)

(** A chain of angles that each step turns too far: so does the composition, strictly if one step did so strictly. *)
Lemma too_far f beta n :
  (forall k, (k < n)%nat -> lift (f k) /\ f k (beta k) <= beta (S k)) ->
  compose f n (beta O) <= beta n /\
  ((exists k, (k < n)%nat /\ f k (beta k) < beta (S k)) -> compose f n (beta O) < beta n).
Proof.
  induction n as [|n IH]; intros H; simpl; [split; [lra | intros (k & K & _); lia]|].
  destruct IH as [W S]; [intros; apply H; lia|]; destruct (H n) as [L B]; [lia|].
  pose proof (lift_le _ _ _ L W); split; [lra|]; intros (k & K & T).
  destruct (Nat.eq_dec k n) as [->|]; [lra|].
  assert (C : compose f n (beta O) < beta n) by (apply S; exists k; split; [lia | exact T]).
  apply (proj1 L) in C; lra.
Qed.

(** Likewise where no step turns far enough. *)
Lemma short_of f alpha n :
  (forall k, (k < n)%nat -> lift (f k) /\ alpha (S k) <= f k (alpha k)) ->
  alpha n <= compose f n (alpha O) /\
  ((exists k, (k < n)%nat /\ alpha (S k) < f k (alpha k)) -> alpha n < compose f n (alpha O)).
Proof.
  induction n as [|n IH]; intros H; simpl; [split; [lra | intros (k & K & _); lia]|].
  destruct IH as [W S]; [intros; apply H; lia|]; destruct (H n) as [L B]; [lia|].
  pose proof (lift_le _ _ _ L W); split; [lra|]; intros (k & K & T).
  destruct (Nat.eq_dec k n) as [->|]; [lra|].
  assert (C : alpha n < compose f n (alpha O)) by (apply S; exists k; split; [lia | exact T]).
  apply (proj1 L) in C; lra.
Qed.

Lemma half_turn_below a b : exists j, a + IZR j * PI < b <= a + IZR j * PI + PI.
Proof.
  pose proof PI_RGT_0 as P; destruct (archimed (- ((b - a) / PI))) as [U L].
  exists (- up (- ((b - a) / PI)))%Z; rewrite opp_IZR; set (u := IZR (up (- ((b - a) / PI)))) in *.
  assert (E : b - a = (b - a) / PI * PI) by (field; lra); set (y := (b - a) / PI) in *.
  split; nra.
Qed.

(** f is the step in between, g the smaller one, h the larger one. Each chain is to be strict for f at one of its steps:
    so it is where it is strict for g (for h), and where f turns strictly further than g (less far than h). *)
Theorem between f g h alpha beta n N :
  (forall k, (k < n)%nat -> lift (f k) /\ forall x, h k x <= f k x <= g k x) ->
  (forall k, (k < n)%nat -> g k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= h k (alpha k)) ->
  (exists k, (k < n)%nat /\ f k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < f k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  exists j, let a := alpha O + IZR j * PI in let b := beta O in let F := compose f n in
    a < b < a + PI /\ a < F a + IZR N * PI /\ F a < F b /\ F b + IZR N * PI < b.
Proof.
  intros L B A SB SA EB EA; set (F := compose f n).
  assert (LF : lift F) by (apply compose_lift; intros; now apply L).
  assert (Fb : F (beta O) < beta n).
  { refine (proj2 (too_far f beta n _) SB); intros k K; destruct (L k K) as [I O]; split; [exact I|].
    specialize (O (beta k)); specialize (B k K); lra. }
  assert (Fa : alpha n < F (alpha O)).
  { refine (proj2 (short_of f alpha n _) SA); intros k K; destruct (L k K) as [I O]; split; [exact I|].
    specialize (O (alpha k)); specialize (A k K); lra. }
  destruct (half_turn_below (alpha O) (beta O)) as (j & J1 & J2); exists j; cbv zeta.
  set (a := alpha O + IZR j * PI) in *.
  assert (Ga : a < F a + IZR N * PI) by (unfold a; rewrite lift_half_turns by exact LF; lra).
  assert (Ne : beta O <> a + PI).
  { intros E; pose proof (proj2 LF a) as X; rewrite <- E in X; lra. }
  assert (F a < F (beta O)) by now apply LF.
  repeat split; lra.
Qed.

(** ** An arc mapped into itself *)

Definition parity (N : Z) : R := if Z.even N then 1 else -1.

Lemma direction_half_turns N x : direction (x + IZR N * PI) = smul (parity N) (direction x).
Proof.
  revert N; apply Z.peano_ind.
  - rewrite Rmult_0_l, Rplus_0_r; apply vec_ext; unfold parity; simpl; ring.
  - intros N IH; rewrite succ_IZR; replace (x + (IZR N + 1) * PI) with (x + IZR N * PI + PI) by ring.
    transitivity (smul (-1) (direction (x + IZR N * PI))).
    + apply vec_ext; simpl; [rewrite neg_cos | rewrite neg_sin]; ring.
    + rewrite IH; unfold parity; rewrite Z.even_succ, <- Z.negb_even.
      destruct (Z.even N); apply vec_ext; simpl; ring.
  - intros N IH; rewrite <- Z.sub_1_r, minus_IZR.
    transitivity (smul (-1) (direction (x + (IZR N - 1) * PI + PI))).
    + apply vec_ext; simpl; [rewrite neg_cos | rewrite neg_sin]; ring.
    + replace (x + (IZR N - 1) * PI + PI) with (x + IZR N * PI) by ring; rewrite IH.
      unfold parity; rewrite Z.sub_1_r, Z.even_pred, <- Z.negb_even.
      destruct (Z.even N); apply vec_ext; simpl; ring.
Qed.

Lemma cross_direction x y : cross (direction x) (direction y) = sin (y - x).
Proof. rewrite sin_minus; unfold cross; simpl; ring. Qed.

(** The sine rule: a direction inside the arc is inside the cone. *)
Lemma inside_arc a b x c : a < b < a + PI -> a < x < b -> 0 < c ->
  inside (direction a) (direction b) (smul c (direction x)).
Proof.
  intros [A B] [X Y] C.
  assert (0 < sin (b - a)) by (apply sin_gt_0; lra).
  assert (0 < sin (x - a)) by (apply sin_gt_0; lra).
  assert (0 < sin (b - x)) by (apply sin_gt_0; lra).
  assert (I : 0 < / sin (b - a)) by now apply Rinv_0_lt_compat.
  assert (Pos : forall s, 0 < s -> 0 < c * s * / sin (b - a)) by (intros; repeat apply Rmult_lt_0_compat; assumption).
  exists (c * sin (b - x) * / sin (b - a)), (c * sin (x - a) * / sin (b - a)).
  split; [now apply Pos|]; split; [now apply Pos|].
  apply vec_ext; simpl; apply Rmult_eq_reg_r with (sin (b - a)); try lra;
    field_simplify; try lra; rewrite !sin_minus; ring.
Qed.

Theorem arc_hyperbolic Q a b x y c d N :
  det Q = 1 -> a < b < a + PI ->
  0 < c -> Q @ direction a = smul c (direction x) ->
  0 < d -> Q @ direction b = smul d (direction y) ->
  a < x + IZR N * PI < b -> a < y + IZR N * PI < b ->
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros D AB C QA E QB X Y; set (u := direction a) in *; set (w := direction b) in *.
  assert (Ne : cross u w <> 0).
  { unfold u, w; rewrite cross_direction; apply Rgt_not_eq, sin_gt_0; lra. }
  assert (In : forall z s, 0 < s -> a < z + IZR N * PI < b ->
    inside u w (smul (parity N) (smul s (direction z)))).
  { intros z s S Z; replace (smul (parity N) (smul s (direction z))) with (smul s (direction (z + IZR N * PI))).
    - now apply inside_arc.
    - rewrite direction_half_turns; apply vec_ext; simpl; ring. }
  assert (U : inside u w (smul (parity N) (Q @ u))) by (rewrite QA; now apply In).
  assert (W : inside u w (smul (parity N) (Q @ w))) by (rewrite QB; now apply In).
  assert (One : forall v, smul 1 v = v) by (intros; apply vec_ext; simpl; ring).
  destruct (cone_criterion Q u w D Ne) as [P M]; unfold parity in U, W.
  destruct (Z.even N) eqn:Ev.
  - rewrite One in U, W.
    destruct (cone_hyperbolic Q u w D Ne) as [T G]; [left; split; assumption|].
    repeat split; [exact T | exact (proj1 G) | exact (proj2 G) | intros _; now apply P|].
    intros O; apply Z.odd_spec in O; rewrite <- Z.negb_even, Ev in O; discriminate.
  - destruct (cone_hyperbolic Q u w D Ne) as [T G]; [right; split; assumption|].
    repeat split; [exact T | exact (proj1 G) | exact (proj2 G) | | intros _; now apply M].
    intros O; apply Z.even_spec in O; rewrite Ev in O; discriminate.
Qed.

(** ** Both together *)

Lemma det_product M n : (forall k, (k < n)%nat -> det (M k) = 1) -> det (product M n) = 1.
Proof.
  induction n as [|n IH]; intros H; simpl; [unfold det; simpl; ring|].
  rewrite det_mul, H, IH by (lia || (intros; apply H; lia)); ring.
Qed.

Lemma sends_product M f n : (forall k, (k < n)%nat -> sends (M k) (f k)) -> sends (product M n) (compose f n).
Proof.
  induction n as [|n IH]; intros H x; simpl.
  - exists 1; split; [lra | apply vec_ext; simpl; ring].
  - destruct (IH (fun k K => H k (Nat.lt_trans _ _ _ K (Nat.lt_succ_diag_r n))) x) as (c & C & E).
    destruct (H n (Nat.lt_succ_diag_r n) (compose f n x)) as (d & D & G).
    exists (c * d); split; [now apply Rmult_lt_0_compat|].
    rewrite act_mul, E; transitivity (smul c (M n @ direction (compose f n x))).
    + apply vec_ext; simpl; ring.
    + rewrite G; apply vec_ext; simpl; ring.
Qed.

Theorem between_unstable M f g h alpha beta n N :
  (forall k, (k < n)%nat -> det (M k) = 1 /\ sends (M k) (f k)) ->
  (forall k, (k < n)%nat -> lift (f k) /\ forall x, h k x <= f k x <= g k x) ->
  (forall k, (k < n)%nat -> g k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= h k (alpha k)) ->
  (exists k, (k < n)%nat /\ f k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < f k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  let Q := product M n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros H L B A SB SA EB EA Q.
  destruct (between f g h alpha beta n N L B A SB SA EB EA) as (j & AB & X & XY & Y).
  set (a := alpha O + IZR j * PI) in *.
  assert (T : sends Q (compose f n)) by (apply sends_product; intros; now apply H).
  destruct (T a) as (c & C & QA), (T (beta O)) as (d & D & QB).
  apply (arc_hyperbolic Q a (beta O) (compose f n a) (compose f n (beta O)) c d N); try assumption; try lra.
  apply det_product; intros; now apply H.
Qed.

(** ** The map of angles of a matrix that turns clockwise *)

(** No direction is sent to its left, and none to its opposite. *)
Definition clockwise (M : mat) :=
  forall x, let u := direction x in cross u (M @ u) <= 0 /\ (cross u (M @ u) = 0 -> 0 < dot u (M @ u)).

Definition turned (M : mat) (x : R) :=
  let u := direction x in x - acos (dot u (M @ u) / len (M @ u)).

Lemma dot_direction x : dot (direction x) (direction x) = 1.
Proof. unfold dot; simpl; pose proof (sin2_cos2 x) as E; unfold Rsqr in E; lra. Qed.

(** The angle that it is turned by, from its cosine and its sine. *)
Lemma turned_angle M x : clockwise M ->
  let u := direction x in let r := len (M @ u) in let t := x - turned M x in
  0 < r /\ 0 <= t < PI /\ r * cos t = dot u (M @ u) /\ r * sin t = - cross u (M @ u).
Proof.
  intros C; destruct (C x) as [K Z]; cbv zeta in *.
  set (u := direction x) in *; set (v := M @ u) in *.
  pose proof (lagrange u v) as G; rewrite (dot_direction x : dot u u = 1), Rmult_1_l, <- len_sqr in G.
  pose proof (len_nonneg v) as P.
  assert (R0 : 0 < len v).
  { destruct (Req_dec (cross u v) 0) as [E|E]; [apply Z in E|]; nra. }
  assert (T : x - turned M x = acos (dot u v / len v)) by (unfold turned; cbv zeta; fold u v; ring).
  rewrite T; set (p := dot u v / len v).
  assert (Ep : dot u v = len v * p) by (unfold p; field; lra).
  assert (Sq : cross u v * cross u v = len v * len v * (1 - p * p)) by (rewrite Ep in G; lra).
  assert (B : -1 <= p <= 1).
  { assert (0 <= 1 - p * p); [|split; nra].
    apply Rmult_le_reg_l with (len v * len v); [nra|]; rewrite <- Sq, Rmult_0_r; apply Rle_0_sqr. }
  pose proof (acos_bound p) as A.
  assert (Cos : cos (acos p) = p) by now apply cos_acos.
  assert (S0 : 0 <= sin (acos p)) by (apply sin_ge_0; lra).
  assert (Sin : len v * sin (acos p) = - cross u v).
  { apply Rsqr_inj; [nra | lra |]; unfold Rsqr.
    pose proof (sin2_cos2 (acos p)) as E; rewrite Cos in E; unfold Rsqr in E.
    transitivity (len v * len v * (sin (acos p) * sin (acos p))); [ring|].
    replace (sin (acos p) * sin (acos p)) with (1 - p * p) by lra; rewrite <- Sq; ring. }
  split; [exact R0|]; split; [|split; [rewrite Cos; now rewrite Ep | exact Sin]].
  split; [lra|]; destruct (Rle_lt_or_eq_dec _ _ (proj2 A)) as [|E]; [assumption | exfalso].
  rewrite E in Sin, Cos; rewrite sin_PI in Sin; rewrite cos_PI in Cos; rewrite <- Cos in Ep.
  assert (0 < dot u v) by (apply Z; lra); lra.
Qed.

Lemma turned_sends M : clockwise M -> sends M (turned M).
Proof.
  intros C x; pose proof (turned_angle M x C) as H; cbv zeta in H.
  set (u := direction x) in *; set (t := x - turned M x) in *; destruct H as (P & _ & Co & Si).
  exists (len (M @ u)); split; [exact P|].
  replace (turned M x) with (x - t) by (unfold t; ring).
  pose proof (dot_direction x) as E; fold u in E.
  assert (Fr : M @ u = add (smul (dot u (M @ u)) u) (smul (cross u (M @ u)) (J u))).
  { set (v := M @ u) in *; destruct v as [p q]; unfold u in *; unfold dot, cross, add, smul, J in *; simpl in *.
    apply vec_ext; simpl.
    - transitivity (p * (cos x * cos x + sin x * sin x)); [rewrite E|]; ring.
    - transitivity (q * (cos x * cos x + sin x * sin x)); [rewrite E|]; ring. }
  rewrite Fr at 1; rewrite <- Co; replace (cross u (M @ u)) with (- (len (M @ u) * sin t)) by lra.
  unfold u at 2 4; apply vec_ext; simpl; [rewrite cos_minus | rewrite sin_minus]; ring.
Qed.

Lemma turned_range M x : clockwise M -> x - PI < turned M x <= x.
Proof. intros C; destruct (turned_angle M x C) as (_ & B & _); lra. Qed.

(** Two sent directions, and the sine of the angle between them. *)
Lemma sent_sine M M' x y : clockwise M -> clockwise M' -> exists c, 0 < c /\
  cross (M @ direction x) (M' @ direction y) = c * sin (turned M' y - turned M x).
Proof.
  intros C C'; destruct (turned_sends M C x) as (c & P & E), (turned_sends M' C' y) as (d & P' & E').
  exists (c * d); split; [now apply Rmult_lt_0_compat|]; rewrite E, E', <- cross_direction; coordinates; ring.
Qed.

Theorem turned_lift M : det M = 1 -> clockwise M ->
  sends M (turned M) /\ lift (turned M) /\ forall x, x - PI < turned M x <= x.
Proof.
  intros D C; split; [now apply turned_sends|]; split; [|intros; now apply turned_range].
  split; intros x.
  - intros y XY; pose proof (turned_range M x C); pose proof (turned_range M y C).
    destruct (Rle_lt_dec (x + PI) y) as [|Near]; [lra|].
    destruct (sent_sine M M x y C C) as (c & P & E).
    assert (S : 0 < sin (y - x)) by (apply sin_gt_0; lra).
    assert (T : cross (M @ direction x) (M @ direction y) = sin (y - x)).
    { rewrite <- cross_direction; transitivity (det M * cross (direction x) (direction y)); [|rewrite D];
        coordinates; ring. }
    rewrite T in E; assert (G : 0 < sin (turned M y - turned M x)) by nra.
    destruct (Rle_lt_dec (turned M y) (turned M x)) as [L|]; [exfalso | assumption].
    assert (0 <= sin (turned M x - turned M y)) by (apply sin_ge_0; lra).
    rewrite <- Ropp_minus_distr, sin_neg in G; lra.
  - unfold turned; cbv zeta.
    assert (E : direction (x + PI) = smul (-1) (direction x)).
    { apply vec_ext; simpl; [rewrite neg_cos | rewrite neg_sin]; ring. }
    assert (A : M @ direction (x + PI) = smul (-1) (M @ direction x)) by (rewrite E; apply vec_ext; simpl; ring).
    rewrite A, len_smul, E.
    replace (Rabs (-1)) with 1 by (rewrite Rabs_left; lra).
    replace (dot (smul (-1) (direction x)) (smul (-1) (M @ direction x))) with (dot (direction x) (M @ direction x))
      by (coordinates; ring).
    rewrite Rmult_1_l; ring.
Qed.

(** Where M' sends each direction to the right of where M does, or to the same one, it has turned it further. *)
Theorem further_turned M M' x : clockwise M -> clockwise M' ->
  0 <= cross (M' @ direction x) (M @ direction x) -> turned M' x <= turned M x.
Proof.
  intros C C' K; destruct (sent_sine M' M x x C' C) as (c & P & E); rewrite E in K.
  pose proof (turned_range M x C); pose proof (turned_range M' x C').
  destruct (Rle_lt_dec (turned M' x) (turned M x)) as [|L]; [assumption | exfalso].
  assert (0 < sin (turned M' x - turned M x)) by (apply sin_gt_0; lra).
  rewrite <- Ropp_minus_distr, sin_neg in K; nra.
Qed.

(** ** Kicks and drifts *)

Definition shear (kicks : bool) (s : R) := if kicks then kick s else drift s.

Theorem clockwise_shear kicks s : 0 <= s -> det (shear kicks s) = 1 /\ clockwise (shear kicks s).
Proof.
  intros S; split; [destruct kicks; unfold det; simpl; ring|].
  intros x; pose proof (dot_direction x) as E; destruct kicks; unfold shear; coordinates;
    set (c := cos x) in *; set (v := sin x) in *; pose proof (Rle_0_sqr c) as Q; pose proof (Rle_0_sqr v) as Q';
    unfold Rsqr in Q, Q'.
  - split; [nra|]; intros Z; assert (Z' : s * (c * c) = 0) by lra.
    destruct (Rmult_integral _ _ Z') as [->|F]; [lra|].
    assert (F' : c = 0) by nra; rewrite F' in *; nra.
  - split; [nra|]; intros Z; assert (Z' : s * (v * v) = 0) by lra.
    destruct (Rmult_integral _ _ Z') as [->|F]; [lra|].
    assert (F' : v = 0) by nra; rewrite F' in *; nra.
Qed.

Theorem further_shear kicks s s' x : 0 <= s <= s' -> turned (shear kicks s') x <= turned (shear kicks s) x.
Proof.
  intros [S T]; apply further_turned; [apply clockwise_shear; lra ..|].
  destruct kicks; unfold shear; coordinates; set (c := cos x); set (v := sin x);
    pose proof (Rle_0_sqr c) as Q; pose proof (Rle_0_sqr v) as Q'; unfold Rsqr in Q, Q'.
  - replace (_ - _) with ((s' - s) * (c * c)) by ring; nra.
  - replace (_ - _) with ((s' - s) * (v * v)) by ring; nra.
Qed.

(** ... and strictly further, but for the one direction that the shear leaves where it is. *)
Lemma strictly_further (kicks : bool) s s' x : 0 <= s < s' -> (if kicks then cos x else sin x) <> 0 ->
  turned (shear kicks s') x < turned (shear kicks s) x.
Proof.
  intros [S T] Ne; destruct (further_shear kicks s s' x) as [|E]; [lra | assumption | exfalso].
  destruct (sent_sine (shear kicks s') (shear kicks s) x x) as (c & P & K); [apply clockwise_shear; lra ..|].
  unfold Rminus in K; rewrite E, Rplus_opp_r, sin_0, Rmult_0_r in K.
  destruct kicks; unfold shear in K; coordinates.
  - assert (Z : (s' - s) * (cos x * cos x) = 0) by lra; apply Rmult_integral in Z; nra.
  - assert (Z : (s' - s) * (sin x * sin x) = 0) by lra; apply Rmult_integral in Z; nra.
Qed.

(** That direction is kept, and it is not the one that the other kind of shear keeps. *)
Lemma kept (kicks : bool) s x : 0 <= s -> (if kicks then cos x else sin x) = 0 ->
  (if kicks then sin (turned (shear kicks s) x) else cos (turned (shear kicks s) x)) <> 0.
Proof.
  intros S Z; destruct (turned_sends (shear kicks s) (proj2 (clockwise_shear kicks s S)) x) as (c & P & E).
  pose proof (dot_direction x) as U; unfold dot in U; simpl in U.
  destruct kicks; unfold shear in *; injection E as E1 E2; rewrite Z in *; intros F; rewrite F in *; nra.
Qed.

(** Shear k is a kick or a drift of strength s k; its strength is low k at the smaller step, high k at the larger one. *)
Definition at_strength (kicks : nat -> bool) (s : nat -> R) (k : nat) := turned (shear (kicks k) (s k)).

Theorem between_shears kicks s low high alpha beta n N :
  (forall k, (k < n)%nat -> 0 <= low k <= s k /\ s k <= high k) ->
  (forall k, (k < n)%nat -> at_strength kicks low k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= at_strength kicks high k (alpha k)) ->
  (exists k, (k < n)%nat /\ at_strength kicks s k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < at_strength kicks s k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  let Q := product (fun k => shear (kicks k) (s k)) n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros O B A SB SA EB EA.
  assert (L : forall k, (k < n)%nat -> det (shear (kicks k) (s k)) = 1 /\ clockwise (shear (kicks k) (s k))).
  { intros k K; specialize (O k K); apply clockwise_shear; lra. }
  apply (between_unstable _ (at_strength kicks s) (at_strength kicks low) (at_strength kicks high) alpha beta n N);
    try assumption.
  - intros k K; destruct (L k K); split; [assumption | now apply turned_lift].
  - intros k K; destruct (L k K); specialize (O k K); split; [now apply turned_lift|].
    intros x; split; apply further_shear; lra.
Qed.

(** A chain of angles of weaker shears: of two neighbours, a kick and a drift, one at least turns it further when stronger. *)
Lemma one_turns_further kicks low s j x :
  kicks (S j) = negb (kicks j) -> 0 <= low j < s j -> 0 <= low (S j) < s (S j) ->
  let y := at_strength kicks low j x in
  at_strength kicks s j x < y \/ at_strength kicks s (S j) y < at_strength kicks low (S j) y.
Proof.
  intros Alt Lj Ls; cbv zeta.
  destruct (Req_dec (if kicks j then cos x else sin x) 0) as [Z|Ne]; [right | left; now apply strictly_further].
  apply strictly_further; [exact Ls|]; pose proof (kept (kicks j) (low j) x (proj1 Lj) Z) as K.
  unfold at_strength; rewrite Alt; destruct (kicks j); exact K.
Qed.

(** And when weaker less far, for a chain of the stronger ones. *)
Lemma one_turns_less kicks s high j x :
  kicks (S j) = negb (kicks j) -> 0 <= s j < high j -> 0 <= s (S j) < high (S j) ->
  let y := at_strength kicks high j x in
  y < at_strength kicks s j x \/ at_strength kicks high (S j) y < at_strength kicks s (S j) y.
Proof.
  intros Alt Lj Ls; cbv zeta.
  destruct (Req_dec (if kicks j then cos x else sin x) 0) as [Z|Ne]; [right | left; now apply strictly_further].
  apply strictly_further; [exact Ls|]; assert (H : 0 <= high j) by lra; pose proof (kept (kicks j) (high j) x H Z) as K.
  unfold at_strength; rewrite Alt; destruct (kicks j); exact K.
Qed.

(** One direction at the smaller step that a period turns by N half turns or more, one at the larger step that it turns by
    N or less (an eigenvector of either period, with N half turns, is both), and a kick next to a drift that both grow. *)
Theorem between_steps kicks s low high x y n N j :
  (forall k, (k < n)%nat -> 0 <= low k <= s k /\ s k <= high k) ->
  (S j < n)%nat -> kicks (S j) = negb (kicks j) -> low j < s j < high j -> low (S j) < s (S j) < high (S j) ->
  compose (at_strength kicks low) n x <= x - IZR N * PI ->
  y - IZR N * PI <= compose (at_strength kicks high) n y ->
  let Q := product (fun k => shear (kicks k) (s k)) n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof.
  intros O J Alt Gj Gs X Y.
  pose proof (O j (Nat.lt_trans _ _ _ (Nat.lt_succ_diag_r j) J)) as Oj; pose proof (O (S j) J) as Os.
  apply (between_shears kicks s low high (fun k => compose (at_strength kicks high) k y)
           (fun k => compose (at_strength kicks low) k x) n N); try assumption; try (intros; simpl; apply Rle_refl).
  - destruct (one_turns_further kicks low s j (compose (at_strength kicks low) j x)) as [T|T]; try assumption; try lra.
    + exists j; split; [lia | exact T].
    + exists (S j); split; [exact J | exact T].
  - destruct (one_turns_less kicks s high j (compose (at_strength kicks high) j y)) as [T|T]; try assumption; try lra.
    + exists j; split; [lia | exact T].
    + exists (S j); split; [exact J | exact T].
Qed.
